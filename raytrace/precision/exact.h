// Exact predicates: whether a line through given doubles intersects a triangle, without any rounding. Signs
// come from doubles with a bound on their error where that decides, from exact numbers where it does not. For
// the filter's form see Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", section 4.
//
// A triangle is closed: a line through an edge or a corner intersects both neighbours. A line in a triangle's
// plane misses it.
#pragma once

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// The sign of dot(direction, cross(a - origin, b - origin)): on which side of the edge a-b the line passes.
int side_of_edge(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b);

/// Whether the line intersects the triangle.
bool line_intersects(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& corners);

/// The sign of t - bound, t being where the line intersects the triangle's plane; the line must intersect the
/// triangle.
int compare_t(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& corners, double bound);

/// The sign of a's t - b's t for two triangles that the line intersects.
int compare_order(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& a,
                  const std::array<Vec3, 3>& b);

/// A triangle's t, rounded.
double exact_t(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& corners);

/// Kernel policy: triangles and their order along the ray by exact predicates, with the robust kernel as
/// their filter; spheres and planes as the robust kernel has them. The ray is taken to be exactly what its
/// doubles say.
class ExactArithmetic {
 public:
  ExactArithmetic(const Structures&, const RayFrame& ray) : given_(ray.t) {}
  bool leaf(const Structures& s, const RayFrame& ray, std::uint32_t index, Hit& hit) const;
  bool plane(const Structures& s, const RayFrame& ray, std::uint32_t id, Hit& hit) const {
    return intersect_plane(s, ray, id, hit);
  }

  /// Told of each hit that became the nearest: what a later one is compared with.
  void took(const Hit& hit) const { taken_ = hit.primitive == found_id_ ? found_ : Intersection{}; }

  /// The t of the nearest hit as its triangle alone gives it. On the traversal it may have been moved to the
  /// right side of another's. Then it would depend on the order of the traversal.
  double own_t(const Structures& s, const RayFrame& ray, const Hit& hit) const;

 private:
  struct Intersection {
    std::array<Vec3, 3> corners;
    Vec2 barycentric{0.0};
    double t = -infinity, spread = 0.0;  ///< the true t is no farther from t than spread
  };
  /// Where the line intersects the triangle, wherever on the line.
  static std::optional<Intersection> intersect(const RayFrame& ray, const LeafPrimitive& triangle);
  bool triangle(const RayFrame& ray, const LeafPrimitive& triangle, Hit& hit) const;
  bool comes_first(const RayFrame& ray, Intersection& candidate) const;
  Interval given_;  ///< the ray's own; a traversal for the closest hit shortens it by rounded values
  mutable Intersection found_{};  ///< the last triangle that was given as a hit
  mutable std::uint32_t found_id_ = no_id;
  mutable Intersection taken_{};  ///< the nearest, if it is a triangle
  mutable bool moved_ = false;    ///< some hit's t was
};

}  // namespace gnomon::raytrace
