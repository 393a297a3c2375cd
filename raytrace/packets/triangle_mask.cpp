#include "raytrace/packets/triangle_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/texture_sample.h"

namespace gnomon::raytrace {
namespace {

/// The corners as points (u, v, 1) z of the rays' plane: z is 1 for a direction.
std::array<Vec3, 3> in_plane(const EdgeSetupPass& pass, const CornerPointers& corners) {
  std::array<Vec3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 from = Vec3(corners[k][0], corners[k][1], corners[k][2]) - pass.origin;
    p[k] = {glm::dot(pass.axes[0], from), glm::dot(pass.axes[1], from),
            pass.directional ? 1.0 : glm::dot(pass.axes[2], from)};
  }
  return p;
}

/// On the lattice of the texture's texel centres; false where the colours of the vertices have an alpha of their own.
bool find_texels(const World& world, std::uint32_t id, const MaskCells& cells, std::array<Vec2, 3>& texels) {
  const WorldPart& part = world.part_of(id);
  const auto vertices = part.triangle(id - part.first_triangle);
  const Material& material = world.scene->materials[part.material_of(id - part.first_triangle)];
  const Vec2 size(cells.size().width, cells.size().height);
  for (std::size_t k = 0; k < 3; ++k) {
    if (part.color(vertices[k]).a != 1.0f) return false;
    const Vec2 uv = part.mesh->uvs.empty() ? Vec2(0.0) : Vec2(part.mesh->uvs[vertices[k]]);
    texels[k] = size * transform_uv(material.texture_transform, uv) - 0.5;
  }
  // Near the texture, where floats tell texels apart.
  const Vec2 whole = size * glm::floor(texels[0] / size);
  for (Vec2& texel : texels) {
    if (cells.repeats_s()) texel.x -= whole.x;
    if (cells.repeats_t()) texel.y -= whole.y;
  }
  return true;
}

constexpr double most_error = 0.9;  ///< texels, of the whole one around a cell that its kind holds for

Vec2 larger(const Vec2& a, const Vec2& b) {
  return glm::max(glm::abs(a), glm::abs(b));
}

}  // namespace

// The corners are p_k = (u_k, v_k, 1) z_k, and n_0 = p_1 x p_2 and so on. The weights of the corners at d = (u, v, 1) are n_k.d
// / w.d, w the sum of all n_k; w.d is det / z_k at corner k, so at least det / z_max inside. A place has a gradient of at most
// (|q| + extent |w|) / min(w.d) there, q.d / w.d being its distance from the first corner's. With u = 2^-24 a ray's floats are
// right to 4 u (1 + |u|) of a point's and 6 u of the radius of a direction's each way (projection-inl.h). A corner as the
// double kernels see it is right to 2^-42 of the largest coordinate (edge_setup_kernel.cpp). Each other corner adds its own.
TriangleMask triangle_mask(const Structures& s, const EdgeSetupPass& pass, std::uint32_t id,
                           const CornerPointers& corners) {
  if (!casts_shadow(s, id)) return {};
  const MaskCells& cells = s.masks[s.world->material_of(id)];
  const std::array<Vec3, 3> p = in_plane(pass, corners);
  std::array<Vec2, 3> texels;
  const double z_min = std::min({p[0].z, p[1].z, p[2].z}), z_max = std::max({p[0].z, p[1].z, p[2].z});
  if (!(z_min > 0.0) || !find_texels(*s.world, id, cells, texels)) return {};
  const Vec3 n1 = glm::cross(p[2], p[0]), n2 = glm::cross(p[0], p[1]);
  const Vec3 w = glm::cross(p[1], p[2]) + n1 + n2;
  TriangleMask mask{.cells = &cells,
                    .u = static_cast<float>(p[0].x / p[0].z),
                    .v = static_cast<float>(p[0].y / p[0].z),
                    .x = {},
                    .y = {},
                    .w = {}};
  const Vec3 first(mask.u, mask.v, 1.0);
  const double scale = 1.0 / glm::dot(w, first), least = std::abs(glm::dot(w, p[0])) / z_max;
  double reach = 0.0, widest = 0.0;  // of the corners, from the first one and from the middle
  for (const Vec3& corner : p) {
    const double at_u = corner.x / corner.z, at_v = corner.y / corner.z;
    reach = std::max({reach, std::abs(at_u - mask.u), std::abs(at_v - mask.v)});
    widest = std::max({widest, std::abs(at_u), std::abs(at_v)});
  }
  const double ray_error = pass.directional ? 0x1.8p-22 * pass.radius : 0x1p-22 * (1.0 + widest);
  const double plane_error = ray_error + 0x1p-40 * pass.largest / z_min;
  const auto put = [&](const Vec3& n, float(&row)[3]) {
    row[0] = static_cast<float>(scale * n.x), row[1] = static_cast<float>(scale * n.y);
    row[2] = static_cast<float>(scale * glm::dot(n, first));
    return (reach * (std::abs(n.x) + std::abs(n.y)) + std::abs(glm::dot(n, first))) / least;
  };
  const Vec2 extent = larger(texels[1] - texels[0], texels[2] - texels[0]);
  const double size_w = put(w, mask.w);
  bool is_known = true;
  const auto set_axis = [&](int a, float(&row)[3]) {
    const Vec3 q = (texels[1] - texels[0])[a] * n1 + (texels[2] - texels[0])[a] * n2;
    const double gradient =
        (std::abs(q.x) + std::abs(q.y) + extent[a] * (std::abs(w.x) + std::abs(w.y))) / least;
    const double base = texels[0][a], size = put(q + base * w, row);
    const double rounding = 0x1p-21 * (size + (std::abs(base) + extent[a]) * size_w);
    is_known = is_known && plane_error * gradient + rounding <= most_error;
  };
  set_axis(0, mask.x), set_axis(1, mask.y);
  if (!is_known) mask.cells = nullptr;
  return mask;
}

}  // namespace gnomon::raytrace
