// The rows of a picture in bands that are at hand at a time: a window that moves down the picture, as high as what is
// measured at a row hangs on rows above and below it (edge_margin).
#pragma once

#include <algorithm>
#include <vector>

#include "compare/edges.h"
#include "compare/image_rows.h"
#include "compare/ladder.h"

namespace gnomon::compare {

/// What a light's neighbouring pixels are asked for.
struct NearLight {
  Image<float> truth, drawn;     ///< V0 and V6
  Image<Label> labels, climbed;  ///< climbed: labels_climbed()
};

class NearRows {
 public:
  /// The band under those that are there. Of its frames only what is needed is kept.
  void add(const raster::RasterFrame& drawn, const raytrace::RayTracedFrame& traced,
           const std::vector<NearLight>& lights);
  /// The rows above this one of the picture are not needed any more.
  void forget_above(int row);
  /// No row is needed any more: what is left of the frames is what they cost, and the maps.
  void forget_images();

  int first() const { return first_; }  ///< of the picture: row 0 here
  int end() const { return first_ + drawn.primitive.size.height; }
  /// The same rows as they are numbered here.
  PictureRows here(const PictureRows& rows) const { return {rows.first - first_, rows.count}; }

  raster::RasterFrame drawn;        ///< primitive; of each light visibility, texel_uv, face, and the map
  raytrace::RayTracedFrame traced;  ///< receiver
  std::vector<NearLight> lights;

 private:
  /// Rows that stay until they are worth the moving of the others, and the most that are at hand.
  static constexpr int spare = std::min(edge_margin, most_spare_rows), most_kept = 2 * edge_margin + spare;
  int first_ = 0;
};

}  // namespace gnomon::compare
