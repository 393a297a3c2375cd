// The map's grid as the sheets see it. Texel coordinates u, v are quotients U / w of two linear functions of the
// world position. *Reciprocal depth* n grows towards the light and is linear in (u, v) on every plane. It is minus
// the depth of an orthographic map, 1 / depth of a perspective one. Along one light ray, whatever has the larger
// reciprocal depth comes first. Tiles of 32 x 32 texels are built one by one.
#pragma once

#include <array>
#include <span>

#include "hybrid/light_facing.h"
#include "scene/light_map/light_view.h"

namespace gnomon::hybrid {

inline constexpr int tile_texels = 32;

/// The texel region of a column is widened by this much against the rounding of whatever is looked up there.
inline constexpr double texel_slack = 0x1p-10;

/// A vertex or receiver on one face of the map.
struct ProjectedPoint {
  double u = 0.0, v = 0.0, w = 0.0;  ///< homogeneous: texels are u / w, v / w; w is 1 on an orthographic map
  double reciprocal_depth = 0.0;
};

/// Linear functions of the world position relative to the view's origin.
struct GridFace {
  Vec3 u, v, w;
  double u_shift = 0.0, v_shift = 0.0;
  double handedness = 1.0;  ///< of (right, up, forward)
};

struct SheetGrid {
  explicit SheetGrid(const World& world, const LightView& view);

  LightView view;
  WorldBounds bounds;
  bool perspective = false;
  std::array<GridFace, 6> faces{};
  int tiles = 0;  ///< on a side of a face
  /// Bound on the error of ProjectedPoint's u and v (texels, times w on a perspective map).
  double grid_error = 0.0;
  /// Perspective: at depths below this, texel coordinates are not known well enough.
  double near_limit = 0.0;
  /// The coordinates are too coarse for such small texels, or the map is warped: nothing is sure.
  bool hopeless = false;

  ProjectedPoint point(int face, const Vec3& world) const;
  /// How far rounding may have moved a reciprocal depth, float's included.
  double reciprocal_depth_error(double reciprocal_depth) const;
  std::size_t tile_index(int face, int tile_x, int tile_y) const {
    const auto n = static_cast<std::size_t>(tiles);
    return (static_cast<std::size_t>(face) * n + static_cast<std::size_t>(tile_y)) * n +
           static_cast<std::size_t>(tile_x);
  }
};

inline ProjectedPoint SheetGrid::point(int face_index, const Vec3& world) const {
  const GridFace& face = faces[static_cast<std::size_t>(face_index)];
  const Vec3 d = world - view.origin;
  ProjectedPoint p;
  p.u = glm::dot(face.u, d) + face.u_shift;
  p.v = glm::dot(face.v, d) + face.v_shift;
  const double depth = glm::dot(face.w, d);
  p.w = perspective ? depth : 1.0;
  p.reciprocal_depth = perspective ? 1.0 / depth : -depth;
  return p;
}

}  // namespace gnomon::hybrid
