// OpenEXR files, written; image_library.h reads them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "scene/files/pictures/exr_encode.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/write_file.h"
#include "scene/image.h"

namespace gnomon {

/// An EXR of a picture that is made in bands: the same file, byte for byte, as write_exr makes. It appears when
/// it is closed.
class ExrFile {
 public:
  ExrFile(std::string path, ImageSize size);
  /// The next rows: a multiple of 16, or the last ones; channels are the same every time, each with a value for each pixel
  /// of the rows. Error (cannot_write), also where the path is no plain file.
  Expected<void> write(const PictureRows& rows, std::span<const Channel> channels,
                       std::span<const std::pair<std::string, std::string>> attributes = {});
  /// `place`: where it appears instead of its path, on the same file system.
  Expected<void> close(const std::string& place);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  ImageSize size_;
  std::optional<ExrEncoder> encoder_;
  std::optional<PartFile> file_;
};

}  // namespace gnomon
