#include "raytrace/packet/seen.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "raytrace/packet/seen_rows.h"

namespace gnomon::raytrace {
namespace {

SeenPrimitive unseen(std::uint32_t id) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {.edge = {},
          .nearness = {},
          .edge_error = inf,
          .depth_error = inf,
          .depth_floor = -inf,
          .id = id | never_sure};
}

SeenPrimitive seen_at(const SeenRows& rows, std::size_t i, std::uint32_t id) {
  SeenPrimitive p;
  for (std::size_t k = 0; k < 9; ++k) p.edge[k / 3][k % 3] = rows.seen[k][i];
  for (std::size_t k = 0; k < 3; ++k) p.nearness[k] = rows.seen[9 + k][i];
  p.edge_error = rows.seen[12][i], p.depth_error = rows.seen[13][i], p.depth_floor = rows.seen[14][i];
  p.id = id;
  return p;
}

bool is_masked(const World& world, std::uint32_t id) {
  return world.scene->materials[world.material_of(id)].alpha_mode == AlphaMode::mask;
}

// A plane's nearness is linear in d as a triangle's is; its edge functions are not asked.
SeenPrimitive see_plane(const Structures& s, const Seen& seen, const SeenPass& pass, std::uint32_t id) {
  const auto& plane = std::get<Plane>(s.world->shape(id).geometry);
  const Vec3 n = plane.normal;
  const double height = glm::dot(n, plane.point - seen.origin), length = glm::length(n);
  const double slope = seen.directional ? glm::dot(n, seen.axes[2]) : height;
  if (is_masked(*s.world, id) ||
      !(std::abs(slope) > 0x1p-30 * length * (pass.directional ? 1.0 : pass.largest)))
    return unseen(id);
  Vec3 m = n / height;
  double error = 0x1p-19 * glm::length(m) + 0x1p-36 * pass.largest * glm::dot(m, m);
  if (seen.directional) {
    m = Vec3(-glm::dot(n, seen.axes[0]), -glm::dot(n, seen.axes[1]), height) / slope;
    error = 0x1p-20 * ((std::abs(m.x) + std::abs(m.y)) * seen.lateral + std::abs(m.z) + pass.radius) +
            0x1p-36 * pass.largest * length / std::abs(slope);
  }
  const double limit = 1e30;
  if (!(max_component(glm::abs(m)) < limit && error < limit)) return unseen(id);
  SeenPrimitive p = unseen(id);
  for (int a = 0; a < 3; ++a) p.nearness[a] = static_cast<float>(m[a]);
  p.depth_error = float_above(error), p.edge_error = 0.0f, p.id = id;
  return p;
}

void see_range(const Structures& s, const SeenPass& pass, std::size_t begin, std::size_t end, Seen& seen) {
  SeenRows rows;
  for (std::size_t first = begin; first < end; first += 8) {
    const std::size_t count = std::min<std::size_t>(8, end - first);
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t k = 0; k < 9; ++k)
        rows.corner[k][i] = s.bvh.primitives[first + std::min(i, count - 1)].v[k];
    see_eight_triangles(rows, pass);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t id = s.bvh.ids[first + i];
      // Spheres are beyond this; a masked triangle is still surely missed where it is missed.
      if (!s.world->is_triangle(id))
        seen.primitives[first + i] = unseen(id);
      else
        seen.primitives[first + i] =
            seen_at(rows, i, s.has_masks && is_masked(*s.world, id) ? id | never_sure : id);
    }
  }
}

void see_all(const Structures& s, const SeenPass& pass, Seen& seen) {
  const std::size_t count = s.bvh.primitives.size();
  seen.primitives = std::make_unique_for_overwrite<SeenPrimitive[]>(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + 7) / 8, 256),
                    [&](const tbb::blocked_range<std::size_t>& r) {
                      see_range(s, pass, 8 * r.begin(), std::min(8 * r.end(), count), seen);
                    });
  for (const std::uint32_t id : s.planes) seen.planes.push_back(see_plane(s, seen, pass, id));
}

double largest_coordinate(const Vec3& v) {
  return max_component(glm::abs(v));
}

double world_reach(const Structures& s) {
  const Aabb& b = s.world->finite_bounds;
  double reach = b.empty() ? 0.0 : std::max(largest_coordinate(b.min), largest_coordinate(b.max));
  for (const std::uint32_t id : s.planes)
    reach = std::max(reach, largest_coordinate(std::get<Plane>(s.world->shape(id).geometry).point));
  return reach;
}

}  // namespace

Seen seen_from(const Structures& s, const Vec3& origin, bool receivers) {
  Seen seen;
  seen.origin = origin;
  seen.axes[0] = {1, 0, 0}, seen.axes[1] = {0, 1, 0}, seen.axes[2] = {0, 0, 1};
  const double world = std::max(world_reach(s), largest_coordinate(origin));
  seen.reach = receivers ? 4.0 * world : world;
  seen.slack =
      0x1p-18 * largest_coordinate(s.world->finite_bounds.extent() + glm::abs(origin - s.bvh.center)) +
      0x1p-38 * seen.reach;
  see_all(s, {.origin = origin, .axes = {}, .largest = seen.reach}, seen);
  return seen;
}

Seen seen_along(const Structures& s, const Vec3& to_light) {
  Seen seen;
  seen.directional = true;
  seen.origin = s.bvh.center;
  seen.axes[2] = to_light / glm::length(to_light);
  orthonormal_basis(seen.axes[2], seen.axes[0], seen.axes[1]);
  const double radius = 0.5 * s.world->finite_bounds.diagonal();
  seen.lateral = 2.0 * radius;
  seen.reach = world_reach(s) + 16.0 * radius;
  seen.slack = 0x1p-17 * radius + 0x1p-38 * seen.reach;
  see_all(s,
          {.origin = seen.origin,
           .axes = {seen.axes[0], seen.axes[1], seen.axes[2]},
           .largest = seen.reach,
           .radius = radius,
           .directional = true},
          seen);
  return seen;
}

}  // namespace gnomon::raytrace
