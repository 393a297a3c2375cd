#include "raytrace/shapes/surface_uv.h"

#include "scene/solid.h"

namespace gnomon::raytrace {

Vec2 surface_uv(const World& world, std::uint32_t primitive, const Vec2& barycentric, const Vec3& position) {
  if (world.is_triangle(primitive)) {
    const auto t = world.triangle(primitive);
    const double b0 = 1.0 - barycentric.x - barycentric.y;
    return b0 * Vec2(world.uv(t[0])) + barycentric.x * Vec2(world.uv(t[1])) +
           barycentric.y * Vec2(world.uv(t[2]));
  }
  const auto& geometry = world.shape(primitive).geometry;
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) {
    const Vec3 n = glm::normalize(position - sphere->center);
    const double turn = std::atan2(n.z, n.x) / (2.0 * pi);
    return {turn - std::floor(turn), std::acos(std::clamp(n.y, -1.0, 1.0)) / pi};
  }
  if (is_solid(geometry)) return solid_uv(geometry, position);
  const auto& plane = std::get<Plane>(geometry);
  Vec3 tangent, bitangent;
  orthonormal_basis(plane.normal, tangent, bitangent);
  return {glm::dot(tangent, position - plane.point), glm::dot(bitangent, position - plane.point)};
}

Vec4f surface_color(const World& world, std::uint32_t primitive, const Vec2& barycentric) {
  if (!world.is_triangle(primitive)) return Vec4f(1.0f);
  const auto t = world.triangle(primitive);
  const double b0 = 1.0 - barycentric.x - barycentric.y;
  return Vec4f(b0 * Vec4(world.color(t[0])) + barycentric.x * Vec4(world.color(t[1])) +
               barycentric.y * Vec4(world.color(t[2])));
}

bool is_masked_out(const World& world, const Material& material, std::uint32_t primitive,
                   const Vec2& barycentric, const Vec3& position) {
  if (material.alpha_mode != AlphaMode::mask) return false;
  float alpha = material.alpha * surface_color(world, primitive, barycentric).a;
  if (material.diffuse_texture != no_id) {
    const Vec2 uv =
        transform_uv(material.texture_transform, surface_uv(world, primitive, barycentric, position));
    alpha *= sample_texture(world.scene->textures[material.diffuse_texture], uv).a;
  }
  return alpha < material.alpha_cutoff;
}

}  // namespace gnomon::raytrace
