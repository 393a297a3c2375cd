// Rows of numbers on the disk, for pictures that are made in bands and read again from their first row on. They
// lie in a file without a name, which is gone with the object or the process.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "scene/base/expected.h"

namespace gnomon {

class RowFile {
 public:
  RowFile() = default;
  /// In that folder ("": the present one), or the nearest one above it that is there. Error (cannot_write): no file can
  /// be made there.
  static Expected<RowFile> open(const std::string& folder);
  RowFile(RowFile&& other) noexcept { *this = std::move(other); }
  RowFile& operator=(RowFile&& other) noexcept;
  ~RowFile();

  /// Behind what is there. Error (cannot_write): the disk is full.
  template <class T>
  Expected<void> append(std::span<const T> numbers) {
    return append_bytes(std::as_bytes(numbers));
  }
  /// Numbers from the one with that place on; they must be there.
  template <class T>
  Expected<void> read(std::uint64_t place, std::span<T> numbers) const {
    return read_bytes(place * sizeof(T), std::as_writable_bytes(numbers));
  }
  std::uint64_t bytes() const { return bytes_; }

 private:
  Expected<void> append_bytes(std::span<const std::byte> bytes);
  Expected<void> read_bytes(std::uint64_t offset, std::span<std::byte> bytes) const;
  int release();
  std::string folder_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
};

}  // namespace gnomon
