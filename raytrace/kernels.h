// The two verbs, specialised by whether the world has alpha masks and whether work is counted.
#pragma once

#include <memory>
#include <utility>

#include "raytrace/accel/structure.h"
#include "raytrace/bvh/traverse.h"
#include "raytrace/bvh/wide_tree.h"
#include "raytrace/precision/facing.h"
#include "raytrace/shapes/mask_cells.h"
#include "raytrace/shapes/solid.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Holds what LeafPrimitive does, in floats; of a triangle the first corner and the edges that leave it.
struct FastPrimitive {
  std::array<float, 9> v;
};

/// What the kernels read. Infinite planes stand apart: they have no box.
struct Structures {
  const World* world = nullptr;
  Bvh bvh;  ///< the default hierarchy; else the primitives alone, in ascending order of ids
  std::shared_ptr<const Structure> structure;  ///< null: it is that, or brute force
  std::unique_ptr<WideOnDemand> wide;          ///< beside the default hierarchy, for single rays
  std::vector<std::uint32_t> planes;           ///< primitive ids, ascending
  Precision precision = Precision::robust;
  std::vector<FastPrimitive> fast;  ///< in leaf order, for Precision::fast alone
  bool has_masks = false;           ///< or what casts no shadow
  bool has_non_casters = false, has_non_receivers = false;
  std::vector<MaskCells> masks;  ///< by material; none where no material has one
  bool hides_backs = false;      ///< some triangle's back is not seen
  bool has_shapes = false;       ///< spheres or solids among the leaves
};

/// traverse() through whichever structure there is.
template <class Stats, class Visit>
bool traverse(const Structures& s, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (s.structure != nullptr) [[unlikely]]
    return traverse_structure(*s.structure, ray, stats.work(), visit);
  return traverse(s.bvh, ray, stats, visit);
}

/// A leaf's primitive.
inline LeafPrimitive leaf_at(const Structures& s, std::uint32_t index) {
  if (s.bvh.has_primitives()) [[likely]]
    return s.bvh.primitive_at(index);
  return leaf_primitive(*s.world, s.bvh.id_at(index));
}

/// One candidate against the ray: fills `hit` (t in kernel units) if the ray intersects it inside ray.t.
inline bool intersect_leaf(const Structures& s, const RayFrame& ray, std::uint32_t index, Hit& hit) {
  const LeafPrimitive primitive = leaf_at(s, index);
  hit.primitive = s.bvh.id_at(index);
  if (s.has_shapes && !s.world->is_triangle(hit.primitive)) {
    hit.barycentric = Vec2(0.0);
    const ShapeGeometry& geometry = s.world->shape(hit.primitive).geometry;
    return is_solid(geometry) ? intersect_solid(ray, geometry, hit.t)
                              : intersect_sphere(ray, primitive, hit.t);
  }
  TriangleHit t;
  if (!intersect_triangle(ray, primitive, t)) return false;
  hit.t = t.t;
  hit.barycentric = Vec2(t.b1, t.b2);
  return true;
}

inline bool intersect_plane(const Structures& s, const RayFrame& ray, std::uint32_t plane, Hit& hit) {
  hit.primitive = plane;
  hit.barycentric = Vec2(0.0);
  return intersect_plane(ray, std::get<Plane>(s.world->shape(plane).geometry), hit.t);
}

/// Kernel policy: how one candidate is tested. The other two are in raytrace/precision/.
struct RobustArithmetic {
  RobustArithmetic(const Structures&, const RayFrame&) {}
  bool leaf(const Structures& s, const RayFrame& ray, std::uint32_t index, Hit& hit) const {
    return intersect_leaf(s, ray, index, hit);
  }
  bool plane(const Structures& s, const RayFrame& ray, std::uint32_t id, Hit& hit) const {
    return intersect_plane(s, ray, id, hit);
  }
};

/// A masked sphere's near side may be a hole while its far side is not; so with each side of a solid.
inline bool passes_alpha_test(const Structures& s, RayFrame ray, Hit& hit) {
  const World& world = *s.world;
  if (!world.is_masked(hit.primitive)) return true;
  const std::uint32_t number = world.material_of(hit.primitive);
  const Material& material = world.scene->materials[number];
  const MaskCells* cells = s.masks.empty() ? nullptr : &s.masks[number];
  const auto position = [&] {
    return Vec3(ray.origin[0], ray.origin[1], ray.origin[2]) +
           hit.t * Vec3(ray.direction[0], ray.direction[1], ray.direction[2]);
  };
  if (!is_masked_out(world, material, cells, hit.primitive, hit.barycentric, position())) return true;
  if (world.is_triangle(hit.primitive)) return false;
  const ShapeGeometry& geometry = world.shape(hit.primitive).geometry;
  if (is_solid(geometry)) {
    for (const double t : solid_crossings(ray, geometry)) {
      if (!(t > hit.t && t < ray.t.max)) continue;
      hit.t = t;
      if (!is_masked_out(world, material, cells, hit.primitive, hit.barycentric, position())) return true;
    }
    return false;
  }
  const auto* sphere = std::get_if<Sphere>(&geometry);
  SphereRoots roots;
  if (sphere == nullptr || !sphere_roots(ray, sphere->center, sphere->radius, roots)) return false;
  if (!(roots.far > hit.t && roots.far < ray.t.max)) return false;
  hit.t = roots.far;
  return !is_masked_out(world, material, cells, hit.primitive, hit.barycentric, position());
}

/// Whether it is a triangle whose back is not seen.
inline bool hides_back(const Structures& s, std::uint32_t primitive) {
  const World& world = *s.world;
  return s.hides_backs && world.is_triangle(primitive) &&
         !shows_back(world.scene->materials[world.material_of(primitive)]);
}
/// Whether what sees goes through: a triangle's back that is not seen.
inline bool is_hidden_back(const Structures& s, const Vec3& direction, std::uint32_t primitive) {
  return hides_back(s, primitive) && is_back(*s.world, direction, primitive);
}

inline bool casts_shadow(const Structures& s, std::uint32_t primitive) {
  return !s.has_non_casters || s.world->casts_shadow(primitive);
}

/// Whether what is looked for may be a primitive met on this side.
inline bool is_on_side(const Structures& s, const Vec3& direction, std::uint32_t primitive, Sides sides) {
  if (sides >= Sides::casting && !casts_shadow(s, primitive)) return false;
  if (sides == Sides::both || sides == Sides::casting || !s.world->is_triangle(primitive)) return true;
  if (sides == Sides::seen) return !is_hidden_back(s, direction, primitive);
  const bool inside_out = s.world->part_of(primitive).is_inside_out();
  return (is_back(*s.world, direction, primitive) != inside_out) == (sides == Sides::backs);
}

inline bool precedes(const Hit& a, const Hit& b) {
  return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

/// The least double above; infinity stays.
inline double next_above(double t) {
  if (!(t < infinity)) return t;
  const auto bits = std::bit_cast<std::int64_t>(t + 0.0);  // -0 becomes 0
  return std::bit_cast<double>(bits >= 0 ? bits + 1 : bits - 1);
}

/// Among the planes and the leaves that report(ray, visit) reports to visit(leaf). `ray` is shortened on the
/// way; visit returns whether it was. The primitive `skip` (no_id: none) is left out. The result's t is the
/// ray's own. `masks`: some hits are none; those on other sides of triangles are so, too.
template <bool masks, class Arithmetic = RobustArithmetic, class Report>
std::optional<Hit> closest_reported(const Structures& s, const RayFrame& frame, std::uint32_t skip,
                                    const Report& report_leaves, Sides sides = Sides::both) {
  const Arithmetic arithmetic(s, frame);
  Hit best{.t = infinity};
  RayFrame ray = frame;
  [[maybe_unused]] const Vec3 direction(frame.direction[0], frame.direction[1], frame.direction[2]);
  // A later hit at the same t may have the lower id, so the interval is closed while the traversal shortens
  // it.
  const auto report = [&](const Hit& hit) {
    if (!precedes(hit, best)) return false;
    if constexpr (requires(const Arithmetic& told) { told.took(hit); }) arithmetic.took(hit);
    best = hit;
    ray.t.max = std::min(frame.t.max, next_above(best.t));
    return true;
  };
  const auto keep = [&](Hit& hit) {
    if constexpr (masks) {
      if (!is_on_side(s, direction, hit.primitive, sides)) return false;
      if (!passes_alpha_test(s, ray, hit)) return false;
    }
    return report(hit);
  };
  Hit hit;
  for (const std::uint32_t plane : s.planes)
    if (plane != skip && arithmetic.plane(s, ray, plane, hit)) keep(hit);
  report_leaves(std::as_const(ray), [&](std::uint32_t i) {
    return arithmetic.leaf(s, ray, i, hit) && hit.primitive != skip && keep(hit);
  });
  if (best.primitive == no_id) return std::nullopt;
  if constexpr (requires { arithmetic.own_t(s, frame, best); }) best.t = arithmetic.own_t(s, frame, best);
  best.t /= frame.kernel_t_from_t;
  return best;
}

/// Among all primitives.
template <bool masks, class Arithmetic = RobustArithmetic, class Stats>
std::optional<Hit> closest(const Structures& s, const RayFrame& frame, std::uint32_t skip, Stats stats,
                           Sides sides = Sides::both) {
  for (const std::uint32_t plane : s.planes)
    if (plane != skip) stats.primitive();
  const auto report = [&](const RayFrame& ray, const auto& visit) {
    BoxRay boxes(ray, s.bvh.center);
    traverse(s, boxes, stats, [&](std::uint32_t i) {
      if (visit(i)) boxes.t_max = float_above(ray.t.max);
      return false;
    });
  };
  return closest_reported<masks, Arithmetic>(s, frame, skip, report, sides);
}

template <bool masks, class Arithmetic = RobustArithmetic, class Stats>
bool any(const Structures& s, const RayFrame& ray, Stats stats) {
  const Arithmetic arithmetic(s, ray);
  Hit hit;
  const auto blocks = [&]() {
    if constexpr (masks) return casts_shadow(s, hit.primitive) && passes_alpha_test(s, ray, hit);
    return true;
  };
  for (const std::uint32_t plane : s.planes) {
    stats.primitive();
    if (arithmetic.plane(s, ray, plane, hit) && blocks()) return true;
  }
  BoxRay boxes(ray, s.bvh.center);
  return traverse(s, boxes, stats,
                  [&](std::uint32_t i) { return arithmetic.leaf(s, ray, i, hit) && blocks(); });
}

}  // namespace gnomon::raytrace
