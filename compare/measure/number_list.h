// A list of numbers that grows band by band: in memory up to a limit, beyond it on the disk.
#pragma once

#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "scene/files/row_file.h"

namespace gnomon::compare {

/// Where lists go that grow beyond a limit.
struct Spill {
  std::string folder{};                                               ///< as RowFile::open has it
  std::size_t above_bytes = std::numeric_limits<std::size_t>::max();  ///< of one list
};

template <class T>
class NumberList {
 public:
  Expected<void> append(const Spill& spill, std::vector<T>&& numbers) {
    if (numbers.empty()) return {};
    const std::size_t before = count_;
    count_ += numbers.size();
    if (count_ * sizeof(T) > spill.above_bytes) return write(spill, numbers, before);
    if (before == 0)
      kept_ = std::move(numbers);
    else
      kept_.insert(kept_.end(), numbers.begin(), numbers.end());
    return {};
  }

  std::size_t count() const { return count_; }

  /// All of them, in their order; the list is empty then.
  Expected<std::vector<T>> take() {
    std::vector<T> numbers = std::move(kept_);
    if (file_.bytes() > 0) {
      numbers.resize(count_);
      if (const auto read = file_.read(0, std::span<T>(numbers)); !read) return fail(read.error());
      file_ = RowFile();
    }
    kept_ = {};
    count_ = 0;
    return numbers;
  }

 private:
  Expected<void> write(const Spill& spill, const std::vector<T>& numbers, std::size_t before) {
    if (file_.bytes() == 0) {
      auto file = RowFile::open(spill.folder);
      if (!file) return fail(file.error());
      file_ = std::move(*file);
      if (before > 0)
        if (const auto moved = file_.append(std::span<const T>(kept_)); !moved) return moved;
      kept_ = {};
    }
    return file_.append(std::span<const T>(numbers));
  }

  std::vector<T> kept_;
  RowFile file_;
  std::size_t count_ = 0;
};

}  // namespace gnomon::compare
