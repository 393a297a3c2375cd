// EXR files of pictures that are made in bands.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "scene/files/pictures/image_io.h"
#include "scene/files/write_file.h"
#include "scene/image.h"

namespace gnomon {

class ExrRows;

/// An EXR of a picture that is made in bands: the same file, byte for byte, as write_exr makes. It appears when
/// it is closed.
class ExrFile {
 public:
  ExrFile(std::string path, ImageSize size);
  ExrFile(ExrFile&&) noexcept;
  ExrFile& operator=(ExrFile&&) noexcept;
  ~ExrFile();
  /// The next rows; channels are the same every time, each with a value for each pixel of the rows. Error
  /// (cannot_write), also where the path is no plain file.
  Expected<void> write(const PictureRows& rows, std::span<const Channel> channels,
                       std::span<const std::pair<std::string, std::string>> attributes = {});
  Expected<void> close();

 private:
  Expected<void> open(std::span<const Channel> channels,
                      std::span<const std::pair<std::string, std::string>> attributes);
  std::string path_;
  ImageSize size_;
  std::optional<PartFile> file_;
  std::unique_ptr<ExrRows> rows_;
};

}  // namespace gnomon
