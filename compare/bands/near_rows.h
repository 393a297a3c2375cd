// The rows of a picture in bands that are at hand at a time: a window that moves down the picture, as high as what is
// measured at a row hangs on rows above and below it.
#pragma once

#include <algorithm>
#include <vector>

#include "compare/ladder.h"
#include "scene/picture_rows.h"

namespace gnomon::compare {

/// Puts rows under those that are there. `kept`: how many are there at most.
template <class T>
void append_rows(Image<T>& rows, const Image<T>& more, int kept) {
  rows.data.reserve(ImageSize{more.size.width, kept + more.size.height}.pixels());
  rows.size = {more.size.width, rows.size.height + more.size.height};
  rows.data.insert(rows.data.end(), more.data.begin(), more.data.end());
}

template <class T>
void drop_rows(Image<T>& rows, int count) {
  if (rows.data.empty()) return;
  rows.data.erase(rows.data.begin(), rows.data.begin() + static_cast<std::ptrdiff_t>(rows.index(0, count)));
  rows.size.height -= count;
}

template <class T>
Image<T> cut_rows(const Image<T>& rows, const PictureRows& wanted) {
  Image<T> out;
  if (rows.data.empty()) return out;
  out.size = {rows.size.width, wanted.count};
  const auto first = rows.data.begin() + static_cast<std::ptrdiff_t>(rows.index(0, wanted.first));
  out.data.assign(first, first + static_cast<std::ptrdiff_t>(out.size.pixels()));
  return out;
}

/// What a light's neighbouring pixels are asked for.
struct NearLight {
  Image<float> truth, drawn;     ///< V0 and V6
  Image<Label> labels, climbed;  ///< climbed: labels_climbed()
};

class NearRows {
 public:
  /// `margin`: rows above and below those that are measured next. Some more stay until they are worth the moving of the
  /// others.
  explicit NearRows(int margin) : spare_(std::min(margin, most_spare)), kept_(2 * margin + spare_) {}

  /// The band under those that are there. Of its frames only what is needed is kept.
  void add(const raster::RasterFrame& drawn, const raytrace::RayTracedFrame& traced,
           const std::vector<NearLight>& lights);
  /// The rows above this one of the picture are not needed any more.
  void forget_above(int row);

  int first() const { return first_; }  ///< of the picture: row 0 here
  int end() const { return first_ + drawn.primitive.size.height; }
  /// The same rows as they are numbered here.
  PictureRows here(const PictureRows& rows) const { return {rows.first - first_, rows.count}; }

  raster::RasterFrame drawn;        ///< primitive; of each light visibility, texel_uv, face, and the map
  raytrace::RayTracedFrame traced;  ///< receiver
  std::vector<NearLight> lights;

 private:
  static constexpr int most_spare = 256;  ///< rows
  int spare_, kept_, first_ = 0;
};

}  // namespace gnomon::compare
