// The rows of a picture that are at hand at a time. What is measured at a row depends on rows above and below it
// (edge_margin). Of a picture in bands a window moves down the picture; a picture in one piece has them all.
#pragma once

#include <algorithm>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/metrics/edges.h"
#include "compare/metrics/image_rows.h"

namespace gnomon::compare {

/// Some rows of a picture, as both renderers made them.
struct Frames {
  raster::RasterFrame drawn;
  raytrace::RayTracedFrame traced;
};

/// What a light's neighbouring pixels are asked for.
struct NearLight {
  const Image<float>&truth, &drawn;     ///< V0 and V6
  const Image<Label>&labels, &climbed;  ///< climbed: labels_climbed()
};

class NearRows {
 public:
  /// The band under those that are there; of a window only what is needed is kept. The band must stay until
  /// forget_above().
  void add(const Frames& band, const ImageSize& picture);
  /// One light's rows of the band that was added last. What is given must stay until forget_above().
  NearLight add(std::size_t light, const Climb& climb, const Image<Label>& climbed);
  /// The rows above this one of the picture are not needed any more, nor is what was given.
  void forget_above(int row);
  /// No row is needed any more: what is left of a window are the maps.
  void forget_images();

  int first() const { return first_; }  ///< of the picture: row 0 of the frames
  /// Returns the frames of the window: primitive; for each light visibility, texel_uv, face, and the map; receivers.
  const Frames& frames() const { return whole_ != nullptr ? *whole_ : window_; }

 private:
  struct LightRows {
    Image<float> truth, drawn;
    Image<Label> labels, climbed;
  };
  /// Rows that stay until they are worth the moving of the others, and the most that are at hand.
  static constexpr int spare = std::min(edge_margin, most_spare_rows), most_kept = 2 * edge_margin + spare;

  const Frames* whole_ = nullptr;  ///< of a picture in one piece
  Frames window_;
  std::vector<LightRows> lights_;
  int first_ = 0;
};

}  // namespace gnomon::compare
