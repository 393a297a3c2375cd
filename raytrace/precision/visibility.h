// Visibility of a light's centre with the error bound's ambiguity made visible. Every test is made for the
// whole box of origins that the surface point's error bound allows. A primitive hit from all of them is a
// sure hit, one hit from some only is ambiguous. A sure hit outweighs any number of ambiguous ones, so closed
// meshes cast no uncertain shadow inside their outline.
#pragma once

#include <optional>

#include "raytrace/kernels.h"
#include "raytrace/precision/dyadic.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Positions in leaf order; nullptr: all.
using LeavesAmong = const std::span<const std::uint32_t>*;

/// `ray` is Tracer::shadow_ray of the point. `among`: whatever else is there, but planes, is surely missed.
/// `last`: as Tracer::centre_visibility has it.
PointVisibility point_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                 LeavesAmong among = nullptr, LastBlocker* last = nullptr);

/// Returns a visibility without ambiguity: what the bounds leave open is decided by exact predicates (ExactShadow says
/// where).
PointVisibility certified_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                     const Light& light, LeavesAmong among = nullptr,
                                     LastBlocker* last = nullptr);

// Whether a primitive blocks the way from a receiver to a light's centre, decided without rounding. The
// receiver is the exact point that its record means. On a triangle that is the mean of the corners with the stored
// weights, on a plane the foot of the stored position. On a sphere or a solid it is the stored position, which is known
// within its bound alone. What lies there within that bound is left out before (AmbiguousRay). The way is the open
// segment between the two points (to infinity for a directional light). Surfaces touched only at its ends do not block
// it.

/// Whether a receiver on this primitive is known exactly: on a triangle or a plane. On a sphere or a solid its stored
/// position is as good as any other within its bound.
inline bool is_known_exactly(const World& world, std::uint32_t primitive) {
  return world.is_triangle(primitive) || std::holds_alternative<Plane>(world.shape(primitive).geometry);
}

class ExactShadow {
 public:
  ExactShadow(const World& world, const SurfacePoint& from, const Light& light)
      : world_(world), from_(from), light_(light) {}

  /// Triangles, planes and spheres are decided, also for a receiver on a solid (its stored position); a
  /// solid's ambiguities stay.
  bool decides(std::uint32_t id) const;
  /// `id` is not the receiver's own triangle or plane, and is decided. A copy of the receiver's own sphere is that sphere.
  bool blocks(std::uint32_t id) const;

 private:
  /// A point as (x, y, z) / w, w > 0.
  struct Receiver {
    Dyadic3 point;
    Dyadic weight;
  };
  bool is_directional() const { return light_.type == LightType::directional; }
  const Receiver& receiver() const;
  /// Positive multiple of (light - receiver).
  Dyadic3 to_light() const;
  bool triangle_blocks(std::uint32_t id) const;
  bool plane_blocks(const Plane& plane) const;
  bool is_own(const Sphere& sphere) const;
  bool sphere_blocks(const Sphere& sphere) const;
  bool source_sphere_blocks(const Sphere& sphere) const;
  /// The sides of a plane through `point` on which receiver and light lie; for a directional light the sign
  /// of the slope towards it.
  bool crosses(const Dyadic3& normal, const Dyadic3& point) const;

  const World& world_;
  const SurfacePoint& from_;
  const Light& light_;
  mutable std::optional<Receiver> receiver_;
};

}  // namespace gnomon::raytrace
