// Input files whose bytes are read where they lie: a large file is mapped into memory, so that only what is
// looked at is read, and nothing is held twice.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "scene/base/expected.h"

namespace gnomon {

/// The bytes of a plain file, for as long as this lives. A file that another program makes shorter meanwhile
/// is not guarded against, as with every program that maps its input.
class MappedFile {
 public:
  /// Errors are read_file's: ErrorKind::bad_input.
  static Expected<MappedFile> open(const std::string& path);

  MappedFile(MappedFile&& other) noexcept { swap(other); }
  MappedFile& operator=(MappedFile&& other) noexcept {
    swap(other);
    return *this;
  }
  ~MappedFile();

  std::string_view bytes() const {
    return mapped_ != nullptr ? std::string_view(mapped_, size_) : std::string_view(read_);
  }

 private:
  MappedFile() = default;
  void swap(MappedFile& other) noexcept {
    std::swap(mapped_, other.mapped_), std::swap(size_, other.size_), std::swap(read_, other.read_);
  }

  const char* mapped_ = nullptr;
  std::size_t size_ = 0;
  std::string read_;  // small files
};

}  // namespace gnomon
