// Where a pixel looks in the map, predicted from the last pixel that shows the same primitive: that one's
// plane, met by this pixel's ray. On flat surfaces next to nothing is left to store. The page's twin is
// page/src/surface_prediction.ts: the same operations in the same order, each of which IEEE 754 fixes to the
// last bit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compare/comparison.h"
#include "report/pixels/packing.h"
#include "scene/camera.h"

namespace gnomon::report {

/// Map positions in 1/position_steps texel, distances in depth steps.
struct LookupNumbers {
  std::vector<std::uint32_t> u, v, distance;
};

/// Rays to pixel centres: from `eye` along corner + (x + 1/2) across + (y + 1/2) down.
struct PixelRays {
  Vec3 eye, corner, across, down;
};
PixelRays pixel_rays(const View& view);

/// What both sides know of the pixels' surfaces.
struct PixelSurfaces {
  PixelRays rays;
  Image<compare::SeenSurface> seen;
  Sources sources;

  std::size_t count() const { return seen.data.size(); }
  std::uint32_t primitive(std::size_t pixel) const { return seen.data[pixel].primitive; }
  Vec3 normal(std::size_t pixel) const { return Vec3(seen.data[pixel].normal); }  ///< of any length
};
PixelSurfaces pixel_surfaces(const compare::Comparison& comparison);

/// Predicts every pixel's lookup from the numbers before it.
LookupNumbers predicted_lookups(const PixelSurfaces& surfaces, const LightView& light,
                                const Image<std::uint8_t>& faces, const LookupNumbers& numbers,
                                double depth_step);

}  // namespace gnomon::report
