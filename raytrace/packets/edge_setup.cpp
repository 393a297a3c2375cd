#include "raytrace/packets/edge_setup.h"

#include <algorithm>
#include <array>

#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/packets/triangle_mask.h"

namespace gnomon::raytrace {
namespace {

PrimitiveEdges void_edges(std::uint32_t id) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {.edge = {},
          .reciprocal_depth = {},
          .edge_error = inf,
          .depth_error = inf,
          .depth_floor = -inf,
          .id = id | never_sure};
}

// A plane's reciprocal depth is linear in d as a triangle's is; its edge functions are not asked.
PrimitiveEdges set_up_plane(const Structures& s, const EdgeSetup& setup, const EdgeSetupPass& pass,
                            std::uint32_t id) {
  const auto& plane = std::get<Plane>(s.world->shape(id).geometry);
  const Vec3 n = plane.normal;
  const double height = glm::dot(n, plane.point - setup.origin), length = glm::length(n);
  const double slope = setup.directional ? glm::dot(n, setup.axes[2]) : height;
  if (s.world->is_masked(id) ||
      !(std::abs(slope) > 0x1p-30 * length * (pass.directional ? 1.0 : pass.largest)))
    return void_edges(id);
  Vec3 m = n / height;
  if (!setup.directional)
    m = Vec3(glm::dot(m, setup.axes[0]), glm::dot(m, setup.axes[1]), glm::dot(m, setup.axes[2]));
  double error = 0x1p-19 * glm::length(m) + 0x1p-36 * pass.largest * glm::dot(m, m);
  if (setup.directional) {
    m = Vec3(-glm::dot(n, setup.axes[0]), -glm::dot(n, setup.axes[1]), height) / slope;
    error = 0x1p-20 * ((std::abs(m.x) + std::abs(m.y)) * setup.lateral + std::abs(m.z) + pass.radius) +
            0x1p-36 * pass.largest * length / std::abs(slope);
  }
  const double limit = 1e30;
  if (!(max_component(glm::abs(m)) < limit && error < limit)) return void_edges(id);
  PrimitiveEdges p = void_edges(id);
  for (int a = 0; a < 3; ++a) p.reciprocal_depth[a] = static_cast<float>(m[a]);
  p.depth_error = float_above(error), p.edge_error = 0.0f, p.id = id;
  return p;
}

}  // namespace

EdgeSetupPass edge_setup_pass(const Structures& s, const EdgeSetup& setup) {
  return {.origin = setup.origin,
          .axes = {setup.axes[0], setup.axes[1], setup.axes[2]},
          .largest = setup.reach,
          .radius = 0.5 * s.world->finite_bounds.diagonal(),
          .farthest = 0.5 * s.world->finite_bounds.diagonal() +
                      glm::length(Vec3(setup.lateral, setup.lateral, setup.height)),
          .directional = setup.directional};
}

namespace {

void set_up_planes(const Structures& s, EdgeSetup& setup) {
  const EdgeSetupPass pass = edge_setup_pass(s, setup);
  for (const std::uint32_t id : s.planes) setup.planes.push_back(set_up_plane(s, setup, pass, id));
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

EdgeSetup edge_setup_from(const Structures& s, const Vec3& origin, bool receivers, const Vec3& right,
                          const Vec3& depth) {
  EdgeSetup setup;
  setup.origin = origin;
  setup.axes[0] = right, setup.axes[1] = glm::cross(depth, right), setup.axes[2] = depth;
  const double world = std::max(world_reach(s), largest_coordinate(origin));
  setup.reach = receivers ? (s.planes.empty() ? 1.0 + 0x1p-10 : 4.0) * world : world;
  setup.slack =
      0x1p-18 * largest_coordinate(s.world->finite_bounds.extent() + glm::abs(origin - s.bvh.center)) +
      0x1p-38 * setup.reach;
  set_up_planes(s, setup);
  return setup;
}

EdgeSetup edge_setup_along(const Structures& s, const Vec3& to_light) {
  EdgeSetup setup;
  setup.directional = true;
  setup.origin = s.bvh.center;
  setup.axes[2] = to_light / glm::length(to_light);
  orthonormal_basis(setup.axes[2], setup.axes[0], setup.axes[1]);
  const double radius = 0.5 * s.world->finite_bounds.diagonal();
  // Infinite planes apart, nothing lies outside the world's sphere.
  constexpr double margin = 1.0 + 0x1p-10;
  setup.lateral = (s.planes.empty() ? margin : 2.0) * radius;
  setup.height = (s.planes.empty() ? margin : 16.0) * radius;
  setup.reach = s.planes.empty() ? margin * world_reach(s) : world_reach(s) + 16.0 * radius;
  setup.slack = 0x1p-17 * radius + 0x1p-38 * setup.reach;
  set_up_planes(s, setup);
  return setup;
}

unsigned set_up_leaves(const Structures& s, const EdgeSetupPass& pass, std::span<const std::uint32_t> leaves,
                       EdgeSetupRows& rows, TriangleMask* masks) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  std::array<PlacedCorners, EdgeSetupRows::together> placed;
  std::array<CornerPointers, EdgeSetupRows::together> triangles;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = s.bvh.corners_at(leaves[std::min(i, leaves.size() - 1)], placed[i]);
  set_up_eight_triangles(triangles, pass, rows);
  if (!s.has_shapes && !s.has_masks) return 0;
  unsigned never = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const std::uint32_t id = s.bvh.id_at(leaves[i]);
    masks[i].cells = nullptr;
    if (!s.world->is_triangle(id)) {
      const float void_rows[EdgeSetupRows::count] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                                     0.0f, 0.0f, 0.0f, 0.0f, inf,  inf,  -inf};
      for (std::size_t k = 0; k < EdgeSetupRows::count; ++k) rows.out[k][i] = void_rows[k];
      never |= 1u << i;
    } else if (s.has_masks && s.world->is_masked(id)) {
      masks[i] = triangle_mask(s, pass, id, triangles[i]);
      never |= static_cast<unsigned>(masks[i].cells == nullptr) << i;
    }
  }
  return never;
}

}  // namespace gnomon::raytrace
