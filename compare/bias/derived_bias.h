// A bias that follows from the map alone, so that an engine can work it out for each light and cascade without drawing.
// Let the light meet a plane at the angle t, and let texels have the width w. A texel whose centre lies `reach` texels away
// along both axes is deeper by sqrt(2) reach w tan t at most. That is what a slope bias of 2 reach adds (raster::Bias::slope;
// the factor of glPolygonOffset, too). A receiver gains as much that moves along its normal by sqrt(2) reach w sin t. It
// gains w tan t times sqrt(2) reach, for it moves towards the light by cos t of its way and along the plane by sin t (Holbein
// 2010). The constant is left with rounding, and with what surfaces bend: a radius of 8 reach w leaves the tangent plane by
// reach w / 8.
#pragma once

#include <optional>
#include <vector>

#include "raster/frame.h"

namespace gnomon::compare {

/// Is the same constant bias on one layer of a map (a cascade; a map in perspective and a cube are one layer, at the depth
/// of the scene's middle) as a length and as a stored number.
struct BiasLayer {
  double texel_world = 0.0;
  double stored_per_world = 0.0;  ///< stored depth per world unit of depth
  double drawn_world = 0.0;    ///< the constant bias that was drawn with, of receivers and casters together
  double derived_world = 0.0;  ///< DerivedBias::constant_texels
};

struct DerivedBias {
  double reach_texels =
      0.5;  ///< how far from a receiver, along either axis, a texel's centre lies that it is compared with
  double constant_texels = 0.0;       ///< of each layer's own texel
  double slope = 1.0;                 ///< as --slope-bias, or
  double normal_offset_texels = 0.0;  ///< as --normal-offset
  std::vector<BiasLayer> layers{};    ///< the finest first
};

/// None where the filter has no fixed reach or compares no single depth (pcss, moments, midpoints, back faces alone, a
/// warped map, izb, hybrid). A filter that follows the receiver's plane needs less.
std::optional<DerivedBias> derive_bias(const raster::MapOptions& map, const raster::LightRecord& record,
                                       const World& world);

/// Is the stored depth per world unit of depth on a face; of a map in perspective where the finite scene's centre lies, or
/// halfway through the map where it has none before the light.
double stored_per_world(const raster::LightRecord& record, int face, const World& world);

}  // namespace gnomon::compare
