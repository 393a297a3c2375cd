#include "scene/files/flat_mesh.h"

namespace gnomon {
namespace {

/// Twice its area beside the square of its longest edge: less is a line up to the rounding of the transform.
constexpr double narrowest_share = 1e-12;

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  return glm::length(glm::cross(ab, ac)) > narrowest_share * longest;
}

}  // namespace

Mesh flattened(const Mesh& mesh, const Mat4& world_from_object) {
  Mesh out = mesh;
  out.normals.clear(), out.triangles.clear(), out.triangle_materials.clear();
  for (Vec3& p : out.positions) p = Vec3(world_from_object * Vec4(p, 1.0));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    if (!has_area(out.positions[a], out.positions[b], out.positions[c])) continue;
    out.triangles.push_back(mesh.triangles[i]);
    if (!mesh.triangle_materials.empty()) out.triangle_materials.push_back(mesh.triangle_materials[i]);
  }
  return out;
}

}  // namespace gnomon
