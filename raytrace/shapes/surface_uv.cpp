#include "raytrace/shapes/mask_cells.h"

#include "scene/shapes/solid.h"

namespace gnomon::raytrace {
namespace {

/// Takes the mean of what a triangle's vertices have.
template <class Mean, class Value>
Mean mean_of(const std::vector<Value>& values, const WorldPart& part, std::uint32_t triangle,
             const Vec2& barycentric) {
  const auto t = part.triangle(triangle - part.first_triangle);
  const double b0 = 1.0 - barycentric.x - barycentric.y;
  return b0 * Mean(values[t[0]]) + barycentric.x * Mean(values[t[1]]) + barycentric.y * Mean(values[t[2]]);
}

}  // namespace

Vec2 surface_uv(const World& world, std::uint32_t primitive, const Vec2& barycentric, const Vec3& position) {
  if (world.is_triangle(primitive)) {
    const WorldPart& part = world.part_of(primitive);
    const std::vector<Vec2f>& uvs = part.mesh->uvs;
    return uvs.empty() ? Vec2(0.0) : mean_of<Vec2>(uvs, part, primitive, barycentric);
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
  const WorldPart& part = world.part_of(primitive);
  const std::vector<Vec4f>& colors = part.mesh->colors;
  return colors.empty() ? Vec4f(1.0f) : Vec4f(mean_of<Vec4>(colors, part, primitive, barycentric));
}

bool is_masked_out(const World& world, const Material& material, const MaskCells* cells,
                   std::uint32_t primitive, const Vec2& barycentric, const Vec3& position) {
  if (material.alpha_mode != AlphaMode::mask) return false;
  const Vec4f color = surface_color(world, primitive, barycentric);
  float alpha = material.alpha * color.a;
  if (material.diffuse_texture != no_id) {
    const Vec2 uv =
        transform_uv(material.texture_transform, surface_uv(world, primitive, barycentric, position));
    const MaskKind kind = cells != nullptr && color.a == 1.0f ? cells->at(uv) : MaskKind::mixed;
    if (kind != MaskKind::mixed) return kind == MaskKind::hole;
    alpha *= sample_texture(world.scene->textures[material.diffuse_texture], uv).a;
  }
  return alpha < material.alpha_cutoff;
}

}  // namespace gnomon::raytrace
