// One texel's column of light rays, and conservative tests of points, segments and triangles against it.
//
// Light space: x along right, y along up, z along forward from the view's origin, world units. The tests are
// made in homogeneous coordinates h = (x, y, 1) of an orthographic map, x and y from its face's centre. A warped
// face has h = (x, y + s b^2, 1 + s y), see scene/light_map/light_view.h; a perspective map has (x, y, z). In
// these coordinates a column is the convex cone of its four corners (x, y, 1). An edge spans a cone with the light
// that needs no division and may reach behind it. "Surely" means: whatever rounding did to the corners, the
// vertices and the map's grid.
#pragma once

#include <array>
#include <span>

#include "raytrace/precision/error_bounds.h"
#include "scene/light_map/light_view.h"

namespace gnomon::raytrace {

/// A vertex as a column's face sees it.
struct LightVertex {
  Vec3 q;        ///< light space
  Vec3 h;        ///< homogeneous
  double error;  ///< bound on each component's error, of q and of h
};

class TexelColumn {
 public:
  TexelColumn(const LightView& view, int face, int column, int row);

  LightVertex vertex(const Vec3& world) const;

  /// All three (or two) vertices lie surely outside one of the column's planes, or behind a perspective
  /// light.
  bool surely_outside(std::span<const LightVertex> vertices) const;
  /// The segment surely misses the column.
  bool surely_misses(const LightVertex& a, const LightVertex& b) const;
  /// The triangle surely misses the column (edge-on triangles: only by the column's own planes).
  bool surely_misses(const std::array<LightVertex, 3>& triangle) const;

  /// Turned towards the light: 1, away: -1, too close to edge-on to say: 0. By the right-hand rule.
  int facing(const std::array<LightVertex, 3>& triangle) const;

 private:
  /// Above 0 on the inner side of one of the four sides.
  double side_value(const Vec3& h, std::size_t side) const {
    if (side < 2) return side == 0 ? h.x - x_[0] * h.z : x_[1] * h.z - h.x;
    return side == 2 ? h.y - y_[0] * h.z : y_[1] * h.z - h.y;
  }
  double plane_error(const LightVertex& v) const {
    return (1.0 + reach_) * v.error + grid_error_ * std::abs(v.h.z);
  }
  /// Which side of the plane through the light and the segment the corners lie on: 1 or -1 when all surely,
  /// else 0.
  int side_of_corners(const LightVertex& a, const LightVertex& b) const;
  Vec3 homogeneous(const Vec3& q) const;

  bool perspective_;
  LightFace face_;
  Vec3 origin_;
  double origin_size_;           // sum of the origin's coordinates
  std::array<double, 2> x_, y_;  // the column's bounds in x / z and y / z (perspective) or x and y
  double reach_;                 // the largest of |x_|, |y_|
  double grid_error_;            // of x_ and y_, and of a texel looked up beside them
  double handedness_;            // of (right, up, forward)
  std::array<Vec3, 4> corners_;  // homogeneous
};

}  // namespace gnomon::raytrace
