#include "app/outputs/picture_bands.h"
#include "scene/files/read_file.h"

#include <algorithm>
#include <filesystem>

namespace gnomon::app {

PictureBands::PictureBands(std::string path, const World& world, const ImageSize& size,
                           std::optional<double> exposure)
    : path_(std::move(path)), world_(world), size_(size), exposure_(exposure) {
  if (lower_extension(path_) == ".exr") exr_.emplace(path_, size);
}

Expected<void> PictureBands::add_color(const ColorImage& color, const PictureRows& rows) {
  if (!exposure_) return keep(color);
  if (!exr_) show(color, rows);
  return {};
}

Expected<void> PictureBands::keep(const ColorImage& color) {
  if (!colors_) {
    auto file = RowFile::open(std::filesystem::path(path_).parent_path().string());
    if (!file) return fail(file.error());
    colors_ = std::move(*file);
  }
  automatic_.count(color.data);
  return colors_->append(std::span<const Vec3f>(color.data));
}

void PictureBands::show(const ColorImage& color, const PictureRows& rows) {
  if (shown_.data.empty()) shown_ = Rgb8Image(size_);
  const Rgb8Image band = display_image(color, *exposure_);
  std::copy(band.data.begin(), band.data.end(), &shown_.at(0, rows.first));
}

template <class Act>
Expected<void> PictureBands::for_each_kept(const Act& act) const {
  for (const PictureRows& rows : bands_of(size_, band_step)) {
    ColorImage color({size_.width, rows.count});
    const std::uint64_t first = color.index(0, rows.first);
    if (const auto read = colors_->read(first, std::span<Vec3f>(color.data)); !read) return read;
    act(color, rows);
  }
  return {};
}

/// Looks at what was kept a second time to learn the exposure, and a third time to show it.
Expected<void> PictureBands::expose() {
  if (automatic_.choose()) {
    const auto learnt =
        for_each_kept([&](const ColorImage& color, const PictureRows&) { automatic_.collect(color.data); });
    if (!learnt) return learnt;
  }
  exposure_ = automatic_.factor();
  if (exr_) return {};
  return for_each_kept([&](const ColorImage& color, const PictureRows& rows) { show(color, rows); });
}

Expected<double> PictureBands::finish(const std::string& place) {
  if (!exposure_)
    if (const auto exposed = expose(); !exposed) return fail(exposed.error());
  colors_.reset();
  const Expected<void> written = exr_ ? exr_->close(place) : write_png(place, shown_);
  if (!written) return fail(written.error());
  return *exposure_;
}

}  // namespace gnomon::app
