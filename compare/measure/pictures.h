// What the pictures of a comparison in bands are drawn from, on the disk until everything is known that they need.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "scene/files/row_file.h"
#include "scene/image.h"

namespace gnomon::compare {

/// One image, row by row from the top.
template <class T>
class StoredImage {
 public:
  Expected<void> append(const std::string& folder, const Image<T>& rows) {
    if (rows.data.empty()) return {};
    if (width_ == 0) {
      auto file = RowFile::open(folder);
      if (!file) return fail(file.error());
      file_ = std::move(*file);
      width_ = rows.size.width;
    }
    return file_.append(std::span<const T>(rows.data));
  }
  /// Empty where nothing was stored.
  Expected<Image<T>> read(const PictureRows& rows) const {
    Image<T> out;
    if (width_ == 0) return out;
    out.size = {width_, rows.count};
    out.data.resize(out.size.pixels());
    const auto first = static_cast<std::uint64_t>(out.index(0, rows.first));
    if (const auto got = file_.read(first, std::span<T>(out.data)); !got) return fail(got.error());
    return out;
  }
  bool empty() const { return width_ == 0; }

 private:
  RowFile file_;
  int width_ = 0;
};

struct StoredLight {
  StoredImage<float> truth, drawn, edges, detachment, flip, ssim;
  StoredImage<Label> labels;
  StoredImage<std::uint8_t> decisions;
};

class PictureStore {
 public:
  PictureStore(const ImageSize& size, std::size_t light_count) : lights(light_count), size_(size) {}

  const ImageSize& size() const { return size_; }
  StoredImage<Vec3f> raster, raytraced;
  std::vector<StoredLight> lights;

  /// What pictures are drawn from; `visibility`: of rays and of maps, and the labels.
  struct Wanted {
    bool raster = false, raytraced = false, visibility = false, edges = false, detachment = false,
         flip = false, ssim = false, decisions = false;
    bool operator==(const Wanted&) const = default;
  };
  /// The comparison and that light alone, with the wanted images of these rows alone.
  Expected<Comparison> rows_of(const Comparison& whole, std::size_t light, const PictureRows& rows,
                               const Wanted& wanted) const;

 private:
  ImageSize size_;
};

}  // namespace gnomon::compare
