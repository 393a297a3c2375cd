// Long lists of numbers of a picture in bands, which wait on the disk until all of them are known.
#pragma once

#include <vector>

#include "scene/files/row_file.h"

namespace gnomon::compare {

template <class T>
class NumberFile {
 public:
  /// `folder`: as RowFile::open has it.
  Expected<void> append(const std::string& folder, const std::vector<T>& numbers) {
    if (numbers.empty()) return {};
    if (count_ == 0) {
      auto file = RowFile::open(folder);
      if (!file) return fail(file.error());
      file_ = std::move(*file);
    }
    count_ += numbers.size();
    return file_.append(std::span<const T>(numbers));
  }

  std::size_t count() const { return count_; }

  /// All of them, in their order; the file is gone then.
  Expected<std::vector<T>> take() {
    std::vector<T> numbers(count_);
    if (const auto read = file_.read(0, std::span<T>(numbers)); !read) return fail(read.error());
    file_ = RowFile();
    count_ = 0;
    return numbers;
  }

 private:
  RowFile file_;
  std::size_t count_ = 0;
};

}  // namespace gnomon::compare
