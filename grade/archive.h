// Archives that strangers packed (zip, tar, 7z), opened in memory by libarchive. Nothing is unpacked onto the disk, no link is followed,
// and how much comes out is limited beforehand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::grade {

/// By its name: ".zip", ".7z", ".tar", ".tgz", ".tar.gz", ".tar.xz", ....
bool is_archive(const std::string& name);

/// How much may still come out of archives; one student's all together.
struct UnpackLimit {
  std::uint64_t bytes = std::uint64_t{64} << 20;  ///< of files that are kept
  std::uint64_t passed = std::uint64_t{1} << 30;  ///< of all files, passed over or kept
  std::uint64_t files = 20000;
  int depth = 3;  ///< archives in archives
};

struct PackedFile {
  std::string name;                  ///< with '/' between folders; neither absolute nor with ".."
  std::optional<std::string> bytes;  ///< none: not asked for
  bool is_link = false;
};

/// Returns the files of an archive, in its order; `keeps` says by a file's name whether its bytes are asked for.
/// Errors (bad input): it cannot be opened, a name that leads out of it, more than `limit` allows.
Expected<std::vector<PackedFile>> open_archive(const std::string& place, std::string_view archive,
                                               bool (*keeps)(const std::string& name), UnpackLimit& limit);

}  // namespace gnomon::grade
