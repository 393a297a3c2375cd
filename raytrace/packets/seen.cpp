#include "raytrace/packets/seen.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "raytrace/packets/seen_rows.h"

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
  if (seen.framed) m = Vec3(glm::dot(m, seen.axes[0]), glm::dot(m, seen.axes[1]), glm::dot(m, seen.axes[2]));
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

}  // namespace

SeenPass seen_pass(const Structures& s, const Seen& seen) {
  return {.origin = seen.origin,
          .axes = {seen.axes[0], seen.axes[1], seen.axes[2]},
          .largest = seen.reach,
          .radius = 0.5 * s.world->finite_bounds.diagonal(),
          .farthest = 0.5 * s.world->finite_bounds.diagonal() +
                      glm::length(Vec3(seen.lateral, seen.lateral, seen.height)),
          .directional = seen.directional,
          .turned = seen.directional || seen.framed};
}

namespace {

// The last leaf stands in for those beyond the end.
void see_rows(const Structures& s, const SeenPass& pass, std::size_t first, SeenRows& rows) {
  const std::size_t last = s.bvh.primitives.size() - 1;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 9; ++k) rows.corner[k][i] = s.bvh.primitives[std::min(first + i, last)].v[k];
  see_eight_triangles(rows, pass);
}

SeenPrimitive seen_leaf(const Structures& s, const SeenRows& rows, std::size_t i, std::size_t leaf) {
  const std::uint32_t id = s.bvh.ids[leaf];
  // Spheres are beyond this; a masked triangle is still surely missed where it is missed.
  if (!s.world->is_triangle(id)) return unseen(id);
  return seen_at(rows, i, s.has_masks && is_masked(*s.world, id) ? id | never_sure : id);
}

void see_planes(const Structures& s, Seen& seen) {
  const SeenPass pass = seen_pass(s, seen);
  for (const std::uint32_t id : s.planes) seen.planes.push_back(see_plane(s, seen, pass, id));
}

void see_all(const Structures& s, Seen& seen) {
  const std::size_t count = s.bvh.primitives.size();
  const SeenPass pass = seen_pass(s, seen);
  seen.primitives = HugeArray<SeenPrimitive>(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + 7) / 8, 256),
                    [&](const tbb::blocked_range<std::size_t>& r) {
                      SeenRows rows;
                      for (std::size_t first = 8 * r.begin(); first < std::min(8 * r.end(), count);
                           first += 8) {
                        see_rows(s, pass, first, rows);
                        for (std::size_t i = 0; i < std::min<std::size_t>(8, count - first); ++i)
                          seen.primitives[first + i] = seen_leaf(s, rows, i, first + i);
                      }
                    });
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

Seen open_seen_from(const Structures& s, const Vec3& origin, bool receivers) {
  Seen seen;
  seen.origin = origin;
  seen.axes[0] = {1, 0, 0}, seen.axes[1] = {0, 1, 0}, seen.axes[2] = {0, 0, 1};
  const double world = std::max(world_reach(s), largest_coordinate(origin));
  seen.reach = receivers ? (s.planes.empty() ? 1.0 + 0x1p-10 : 4.0) * world : world;
  seen.slack =
      0x1p-18 * largest_coordinate(s.world->finite_bounds.extent() + glm::abs(origin - s.bvh.center)) +
      0x1p-38 * seen.reach;
  see_planes(s, seen);
  return seen;
}

void frame_seen(const Structures& s, const Vec3& right, const Vec3& depth, Seen& seen) {
  seen.axes[0] = right, seen.axes[1] = glm::cross(depth, right), seen.axes[2] = depth;
  seen.framed = true;
  seen.planes.clear();
  see_planes(s, seen);
}

Seen open_seen_along(const Structures& s, const Vec3& to_light) {
  Seen seen;
  seen.directional = true;
  seen.origin = s.bvh.center;
  seen.axes[2] = to_light / glm::length(to_light);
  orthonormal_basis(seen.axes[2], seen.axes[0], seen.axes[1]);
  const double radius = 0.5 * s.world->finite_bounds.diagonal();
  // Infinite planes apart, nothing lies outside the world's sphere.
  constexpr double margin = 1.0 + 0x1p-10;
  seen.lateral = (s.planes.empty() ? margin : 2.0) * radius;
  seen.height = (s.planes.empty() ? margin : 16.0) * radius;
  seen.reach = s.planes.empty() ? margin * world_reach(s) : world_reach(s) + 16.0 * radius;
  seen.slack = 0x1p-17 * radius + 0x1p-38 * seen.reach;
  see_planes(s, seen);
  return seen;
}

Seen seen_from(const Structures& s, const Vec3& origin, bool receivers) {
  Seen seen = open_seen_from(s, origin, receivers);
  see_all(s, seen);
  return seen;
}

Seen seen_along(const Structures& s, const Vec3& to_light) {
  Seen seen = open_seen_along(s, to_light);
  see_all(s, seen);
  return seen;
}

void see_block(const Structures& s, const SeenPass& pass, std::size_t first, SeenBlock& block) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  see_rows(s, pass, first, block.rows);
  const auto set = [&](std::size_t i, float sign) {
    const float bounds[SeenRows::bounds] = {-sign * inf, sign * inf, -sign * inf, sign * inf, inf};
    for (std::size_t k = 0; k < SeenRows::bounds; ++k) block.rows.seen[SeenRows::numbers + k][i] = bounds[k];
  };
  const std::size_t count = std::min<std::size_t>(8, s.bvh.primitives.size() - first);
  for (std::size_t i = 0; i < count; ++i)
    if (!s.world->is_triangle(s.bvh.ids[first + i])) set(i, 1.0f);
  for (std::size_t i = count; i < 8; ++i) set(i, -1.0f);
}

unsigned see_leaves(const Structures& s, const SeenPass& pass, std::span<const std::uint32_t> leaves,
                    SeenBlock& block) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < 8; ++i) {
    const LeafPrimitive& p = s.bvh.primitives[leaves[std::min(i, leaves.size() - 1)]];
    for (std::size_t k = 0; k < 9; ++k) block.rows.corner[k][i] = p.v[k];
  }
  see_eight_triangles(block.rows, pass);
  if (!s.has_shapes && !s.has_masks) return 0;
  unsigned never = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const std::uint32_t id = s.bvh.ids[leaves[i]];
    if (!s.world->is_triangle(id)) {
      const float void_rows[SeenRows::count] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                                0.0f, 0.0f, inf,  inf,  -inf, -inf, inf,  -inf, inf,  inf};
      for (std::size_t k = 0; k < SeenRows::count; ++k) block.rows.seen[k][i] = void_rows[k];
      never |= 1u << i;
    } else if (s.has_masks && is_masked(*s.world, id)) {
      never |= 1u << i;
    }
  }
  return never;
}

SeenPrimitive primitive_in(const Structures& s, const SeenBlock& block, std::size_t i, std::size_t leaf) {
  return seen_leaf(s, block.rows, i, leaf);
}

}  // namespace gnomon::raytrace
