// The scene flattened into world space: what both renderers draw. Instances become triangles, in double
// precision, with one numbering of primitives: triangles 0 … T-1 (instance by instance), then shapes T …
// T+S-1. Objects are numbered the same way: instances first, then shapes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace gnomon {

struct World {
  const Scene* scene = nullptr;  ///< materials, textures, lights; must outlive the World

  // Vertices, world space. normals and uvs are as long as positions (zero where a mesh has none).
  std::vector<Vec3> positions;
  std::vector<Vec3f> normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec4f> colors;  ///< as long as positions, white where a mesh has none; empty where none has any
  // Triangles. Where a mirrored instance has single-sided materials, its corners' order is turned round, so that their
  // front is again the side from which they run counter-clockwise.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_material;
  std::vector<std::uint32_t> triangle_object;
  // Shapes (world space already)
  std::span<const Shape> shapes;

  Aabb finite_bounds;  ///< of everything but planes

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles.size()); }
  std::uint32_t primitive_count() const {
    return triangle_count() + static_cast<std::uint32_t>(shapes.size());
  }
  bool is_triangle(std::uint32_t primitive) const { return primitive < triangles.size(); }
  const Shape& shape(std::uint32_t primitive) const { return shapes[primitive - triangle_count()]; }
  std::uint32_t material_of(std::uint32_t primitive) const {
    return is_triangle(primitive) ? triangle_material[primitive] : shape(primitive).material;
  }
  std::uint32_t object_of(std::uint32_t primitive) const;
  std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const auto& t = triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

World make_world(const Scene& scene);

/// Outward geometric normal of a primitive at a point on it, unit length; of a triangle by the right-hand
/// rule (zero for a degenerate triangle).
Vec3 geometric_normal(const World& world, std::uint32_t primitive, const Vec3& position);

}  // namespace gnomon
