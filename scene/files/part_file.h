// Files that something else writes, row by row.
#pragma once

#include <string>
#include <utility>

#include "scene/expected.h"

namespace gnomon {

/// A file that others write, and that appears under its final name when it is published. It has no name before,
/// where the file system knows such files, so that nothing is left of it when the process ends.
class PartFile {
 public:
  /// Empty, beside `path`. ErrorKind::cannot_write, also where that is there and no plain file.
  static Expected<PartFile> create(const std::string& path);
  PartFile(PartFile&& other) noexcept { *this = std::move(other); }
  PartFile& operator=(PartFile&& other) noexcept;
  ~PartFile();
  std::string path() const;  ///< to be written to
  Expected<void> publish();

 private:
  PartFile() = default;
  std::string target_, part_;
  int descriptor_ = -1;
};

}  // namespace gnomon
