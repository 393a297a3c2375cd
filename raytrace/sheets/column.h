// One texel's column of light rays, and conservative tests of points, segments and triangles against it.
//
// Light space: x along right, y along up, z along forward from the view's origin, world units. The tests are
// made in homogeneous coordinates h = (x, y, 1) of an orthographic map (x and y from its face's centre; a
// warped face's h = (x, y + s b^2, 1 + s y), see scene/light_view.h) and (x, y, z) of a perspective one;
// there a column is the convex cone of its four corners (x, y, 1), and an edge spans a cone with the light
// that needs no division and may reach behind it. "Surely" means: whatever rounding did to the corners, the
// vertices and the map's grid.
#pragma once

#include <array>
#include <span>

#include "raytrace/error_bounds.h"
#include "scene/light_view.h"

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

  bool perspective() const { return perspective_; }
  LightVertex vertex(const Vec3& world) const;

  /// All three (or two) vertices lie surely outside one of the column's planes, or behind a perspective
  /// light.
  bool surely_outside(std::span<const LightVertex> vertices) const;
  /// The segment surely misses the column.
  bool surely_misses(const LightVertex& a, const LightVertex& b) const;
  /// The triangle surely misses the column (edge-on triangles: only by the column's own planes).
  bool surely_misses(const std::array<LightVertex, 3>& triangle) const;
  /// The vertex may lie inside the column.
  bool may_contain(const LightVertex& v) const { return !surely_outside({&v, 1}); }

  /// Turned towards the light: 1, away: -1, too close to edge-on to say: 0. By the right-hand rule.
  int facing(const std::array<LightVertex, 3>& triangle) const;

  /// Bounds on the distance along the light rays of the part of a flat polygon inside the column (a little
  /// more than the column, by the error bounds). Empty when nothing is left.
  Interval distances(std::span<const LightVertex> polygon) const;

  /// The column's corners in light space, in turn: directions with z = 1 (perspective), or points at z = 1.
  const std::array<Vec3, 4>& corners() const { return light_corners_; }
  /// The rectangle around the corners.
  Vec2 min() const { return low_; }
  Vec2 max() const { return high_; }
  const Vec3& origin() const { return origin_; }
  const LightFace& face() const { return face_; }
  /// Of the corners and of the rectangle.
  double grid_error() const { return corner_error_; }

 private:
  /// Above 0 on the inner side of one of the four sides.
  double side_value(const Vec3& h, std::size_t side) const {
    if (side < 2) return side == 0 ? h.x - x_[0] * h.z : x_[1] * h.z - h.x;
    return side == 2 ? h.y - y_[0] * h.z : y_[1] * h.z - h.y;
  }
  /// The same of a place in light space; the fifth plane's is the distance along forward.
  double plane_value(const Vec3& q, std::size_t plane) const {
    return plane < 4 ? side_value(homogeneous(q), plane) : q.z;
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
  std::array<Vec3, 4> light_corners_;
  Vec2 low_, high_;
  double corner_error_;  // of light_corners_
};

}  // namespace gnomon::raytrace
