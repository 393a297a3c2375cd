// A picture that comes in bands, as a file: the same, byte for byte, as that of the whole (picture_file.h).
#pragma once

#include <optional>
#include <string>

#include "app/outputs/picture_command.h"
#include "app/outputs/picture_file.h"
#include "scene/exposure.h"
#include "scene/files/pictures/exr_file.h"
#include "scene/files/row_file.h"
#include "scene/image.h"

namespace gnomon::app {

class PictureBands {
 public:
  /// `exposure`: known_exposure(). Without it the colours are kept in a file until all are known.
  PictureBands(std::string path, const World& world, const ImageSize& size, std::optional<double> exposure);

  /// From top to bottom.
  template <class Frame>
  Expected<void> add(const Frame& frame, const PictureRows& rows) {
    if (exr_)
      if (const auto written = exr_->write(rows, exr_channels(world_, frame)); !written) return written;
    return add_color(frame.color, rows);
  }
  /// Finishes the file, at a place on the file system that its path is on, and tells its exposure.
  Expected<double> finish(const std::string& place);

 private:
  Expected<void> add_color(const ColorImage& color, const PictureRows& rows);
  Expected<void> keep(const ColorImage& color);
  Expected<void> expose();
  /// act(colours, rows) for all that were kept, band by band.
  template <class Act>
  Expected<void> for_each_kept(const Act& act) const;
  void show(const ColorImage& color, const PictureRows& rows);

  std::string path_;
  const World& world_;
  ImageSize size_;
  std::optional<double> exposure_;
  std::optional<ExrFile> exr_;
  Rgb8Image shown_;  ///< of a .png
  AutoExposure automatic_;
  std::optional<RowFile> colors_;
};

/// Writes the file of a frame that holds the whole picture, at `place`, and tells its exposure.
template <class Frame>
Expected<double> write_whole(const PictureCommand& command, const LoadedScene& loaded, const Frame& frame,
                             const std::string& place) {
  const double exposure = choose_exposure(command.exposure, *loaded.scene, frame.color);
  const auto written = write_picture(place, *loaded.world, frame, exposure);
  if (!written) return fail(written.error());
  return exposure;
}

}  // namespace gnomon::app
