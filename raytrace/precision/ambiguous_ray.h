// A shadow ray whose origin is known only within an error bound, and how it intersects one primitive. Every
// test is made for the whole box of origins at once: what is hit from all of them is surely hit, what is hit
// from some only perhaps.
#pragma once

#include "raytrace/kernels.h"
#include "raytrace/shapes/solid.h"

namespace gnomon::raytrace {

// Whether a ray from a point that is known only within an error bound crosses a solid: surely, perhaps, or
// surely not. By interval arithmetic, for all origins within the bound at once.

enum class Intersects : std::uint8_t { no, perhaps, surely };

/// Crossings count in ray.t; from its end to `surely_out` they may count. `error`: of the origin, per axis of
/// the world. `source_normal`: for a ray that leaves this solid, its normal there on the side the ray leaves
/// to (else none). The start itself is no crossing. Nor is that of a ray which starts on the solid within the error and
/// clearly leaves its surface there, to whichever side. Such a solid is the same surface in another description.
Intersects intersects_solid(const RayFrame& ray, double surely_out, const Vec3& error,
                            const ShapeGeometry& solid, const Vec3* source_normal);

/// How far the ray's true origin may lie from its own.
inline Vec3 origin_error(const SurfacePoint& from, const Ray& ray) {
  return from.position_error + glm::abs(ray.origin - from.position);
}
/// shadow_ray ends before the light by less than this.
inline double beyond_end(const Vec3& error, const Ray& ray) {
  return 2.0 * (glm::dot(error, Vec3(1.0)) + error_gamma(8) * ray.t.max);
}

/// The ray leaves the plane behind it, so clearly that intersects_plane() says no, too: by eight times its
/// bounds, where half would do. `error` as origin_error() has it.
bool clearly_leaves(const Plane& plane, const Ray& ray, const Vec3& error);

class AmbiguousRay {
 public:
  /// `decided`: every ambiguity is decided by exact predicates afterwards, so none may be left out for being
  /// too small to matter, but what the receiver alone makes ambiguous: see takes_receiver().
  AmbiguousRay(const World& world, const SurfacePoint& from, const Ray& ray, const RayFrame& frame,
               bool decided);

  const RayFrame& frame() const { return ray_; }
  const SurfacePoint& from() const { return from_; }
  const Vec3& error() const { return error_; }  ///< of the origin
  /// The exact predicates take the receiver as it is given (is_known_exactly). What another one lies on within its bound is
  /// left out as it is where nothing is decided.
  bool takes_receiver() const { return decided_ && is_known_; }
  /// In the frame's t: nothing from here on can be in the way.
  double surely_out() const { return surely_out_; }

  /// By bounds that hold for every triangle of the world: quick, and finds most misses.
  bool clearly_misses(const ShearedTriangle& t) const {
    double size = 0.0;
    for (std::size_t i = 0; i < 3; ++i) size += std::abs(t.x[i]) + std::abs(t.y[i]);
    const double bound = 2.0 * coarse_error_ * (size + coarse_error_);
    const double low = std::min({t.u, t.v, t.w}), high = std::max({t.u, t.v, t.w});
    return low < -bound && high > bound;
  }
  /// `edge` is set when the ambiguity is about one edge alone: from that corner to the next.
  Intersects intersects_triangle(const ShearedTriangle& sheared, const LeafPrimitive& triangle,
                                 int& edge) const;
  /// Whether the ray may come to the triangle's own box. Along the whole line of a triangle seen edge-on its
  /// edge functions are ambiguous; every structure's boxes hold this one, so that what is ambiguous does not
  /// depend on the structure.
  bool passes_box(const LeafPrimitive& triangle) const;
  Intersects intersects_plane(std::uint32_t id) const;
  /// Any shape but a plane.
  Intersects intersects_shape(std::uint32_t id) const;

  /// The ray surely leaves on the upper side of the tangent plane at its point. Nothing at or below that plane (but
  /// for rounding) can be in its way: coplanar neighbours, coplanar duplicates, the far side of a convex body. Not
  /// what is so near, or along so flat a ray, that the ray stays within that rounding all along it.
  bool below_horizon(std::uint32_t id) const;
  /// Nothing that lies wholly beyond the plane through the light, across the ray, can be in its way. The ray
  /// ends before the light by its own error bound; a body that the light touches from behind is told apart
  /// so.
  bool beyond_light(std::uint32_t id) const;

 private:
  /// At least so much of the direction is along the normal.
  double rise() const;
  /// The light lies above the tangent plane at the ray's point by more than both are known.
  bool clearly_rises() const;
  struct Interval3 {  // of a ray parameter
    double lo, hi;
  };

  /// `t` against the ray's interval.
  Intersects in_interval(const Interval3& t) const;
  /// Where along the ray the triangle may be intersected: a mean of the corners' depths with weights known
  /// within det_error.
  Interval3 depth_range(const ShearedTriangle& s, double det_error, double depth_error) const;
  /// A plane through the point whose normal is the point's own, but for rounding.
  bool is_same_surface(const Plane& plane) const;
  Intersects intersects_sphere(std::uint32_t id) const;
  /// Which root of a sphere the start of the ray is, if it is one.
  enum class Start : std::uint8_t { elsewhere, near, far };
  Start start_on(std::uint32_t id, const Vec3& offset, const Interval3& near, const Interval3& far) const;

  const World& world_;
  const SurfacePoint& from_;
  const RayFrame& ray_;
  bool decided_, is_known_;
  double surely_out_;
  Vec3 error_;
  double error_x_, error_y_, coarse_error_;
};

}  // namespace gnomon::raytrace
