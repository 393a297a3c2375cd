// Which boxes a clip matrix shows nothing of, so that what is in them need not be drawn (Assarsson and Möller 2000,
// "Optimized view frustum culling algorithms for bounding boxes", section 2). Private to raster.
#pragma once

#include <array>

#include "scene/math.h"

namespace gnomon::raster {

/// The sides of what a clip matrix shows: left, right, top, bottom, and what is behind a perspective's eye. The near and
/// the far side are none of them, for depths are clamped there (GL_DEPTH_CLAMP).
class ClipSides {
 public:
  /// clip_from_relative: to homogeneous clip coordinates, of places that count from `reference` (world units).
  ClipSides(const Mat4& clip_from_relative, const Vec3& reference);

  /// Whether all of the box lies beyond one side, for floats as well: then its triangles cover no pixel.
  bool surely_outside(const Aabb& world_box) const;

 private:
  static constexpr std::size_t count = 5;
  Vec3 reference_;
  std::array<Vec4, count> side_;  ///< dot(side, (p, 1)) >= 0 within
  std::array<Vec4, count> size_;  ///< of the terms that floats add up for it
};

}  // namespace gnomon::raster
