// The filtering techniques worked out on the CPU in double precision from the depth map that was read back:
// slow, straight from the papers' formulas, and without a line in common with the shaders.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "judge/moments.h"
#include "raster/passes/light_block.h"
#include "scene/light.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {

inline Scene lit_still_life(LightType type) {
  Scene scene = still_life(false);
  scene.lights = {type == LightType::directional ? sun({-0.5, -1.0, -0.6})
                                                 : lamp(type, {0.3, 3.2, 1.2}, {0.0, 0.0, 0.0})};
  return scene;
}

/// A small map whose filter has no mipmaps.
inline raster::RasterOptions technique_options(raster::Technique technique) {
  raster::RasterOptions options = small_options(128);
  options.map.technique = technique;
  options.map.bias.constant = 1.5;
  options.map.filter.mipmaps = false;
  options.map.filter.receiver_plane = technique == raster::Technique::pcss;
  return options;
}

/// A receiver that the reference can be asked about: in the map's texels, with its plane.
struct FilterReceiver {
  std::size_t pixel = 0;
  Vec3 position, normal, to_light;
  TexelCoordinate at;
  double slack = 0.0;  ///< gap that is still lit
};

/// Depth at which the ray through (u, v) meets the receiver's plane.
inline double receiver_plane_depth(const LightView& view, const FilterReceiver& r, double u, double v) {
  const Ray ray = texel_ray(view, r.at.face, u, v);
  return depth_of(view, r.at.face, ray,
                  glm::dot(r.normal, r.position - ray.origin) / glm::dot(r.normal, ray.direction));
}

/// Calls check for every receiver that faces the light, away from the picture's edges and from the map's.
inline void for_receivers(const Drawn& drawn, double margin_texels,
                          const std::function<void(const FilterReceiver&)>& check) {
  const View view = drawn.view();
  const LightView& map = drawn.light().map.view;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit || hit->primitive == no_id || !drawn.world->is_triangle(hit->primitive)) continue;
      FilterReceiver r;
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      r.pixel = drawn.frame.primitive.index(x, y);
      r.position = ray.at(hit->t);
      r.normal = face_forward(geometric_normal(*drawn.world, hit->primitive, r.position), ray.direction);
      r.to_light = light_at(drawn.scene->lights[0], r.position).to_light;
      if (glm::dot(r.normal, r.to_light) < 0.1) continue;
      r.at = project_to_texel(map, r.position);
      const double low = std::min(r.at.u, r.at.v), high = std::max(r.at.u, r.at.v);
      if (low < margin_texels || high > map.size - margin_texels) continue;
      r.slack = drawn.light().bias_constant_world;
      check(r);
    }
  }
}

/// The hard comparison with one texel of the receiver's face; `ambiguous` is set where rounding could decide it.
inline double lit_at(const Drawn& drawn, const FilterReceiver& r, int column, int row, bool& ambiguous) {
  const auto& map = drawn.light().map;
  const double stored = map.depth[map.texel_index(r.at.face, column, row)];
  if (!(stored < 1.0)) return 1.0;
  const bool plane = drawn.frame.options.map.bias.receiver_plane;
  const double depth = plane ? receiver_plane_depth(map.view, r, column + 0.5, row + 0.5) : r.at.depth;
  const double along = map.view.projection == LightProjection::perspective ? r.at.distance / r.at.depth : 1.0;
  const double margin = (depth - depth_from_stored(map.view, r.at.face, row + 0.5, stored)) * along - r.slack;
  if (std::abs(margin) < 5e-5 + 1e-4 * std::abs(depth - r.at.depth))
    ambiguous = true;  // float on lengths of ten units
  return margin > 0.0 ? 0.0 : 1.0;
}

/// A face's values, averaged over squares of (2 n + 1)^2 texels.
class BlurredFace {
 public:
  using Value = std::array<double, 4>;
  BlurredFace(const raster::ShadowMap& map, int face, int radius, const std::function<Value(double)>& moments)
      : size_(map.view.size), values_(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_)) {
    for (int row = 0; row < size_; ++row)
      for (int column = 0; column < size_; ++column)
        at(column, row) = moments(share_of(map, face, column, row));
    blur(radius, 1, 0);
    blur(radius, 0, 1);
  }
  Value bilinear(double u, double v) const {
    const double x = u - 0.5, y = v - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    Value out{};
    for (int dj = 0; dj <= 1; ++dj)
      for (int di = 0; di <= 1; ++di)
        for (std::size_t k = 0; k < 4; ++k)
          out[k] += (di ? x - i : 1.0 - x + i) * (dj ? y - j : 1.0 - y + j) * clamped(i + di, j + dj)[k];
    return out;
  }

  /// 0 at the near depth, 1 at the farthest corner, along the light ray.
  static double share(const LightView& view, double distance) {
    const bool perspective = view.projection == LightProjection::perspective;
    const LightFace& face = view.faces[0];  // all alike
    const double tangents = perspective ? glm::length(Vec3(face.half_extent, 1.0)) : 1.0;
    return (distance - face.near_depth) / (face.far_depth * tangents - face.near_depth);
  }

 private:
  static double share_of(const raster::ShadowMap& map, int face, int column, int row) {
    const double stored = map.depth[map.texel_index(face, column, row)];
    if (!(stored < 1.0)) return 1.0;
    const double depth = depth_from_stored(map.view, face, row + 0.5, stored);
    if (map.view.projection == LightProjection::orthographic) return share(map.view, depth);
    const Ray ray = texel_ray(map.view, face, column + 0.5, row + 0.5);
    return share(map.view,
                 depth / glm::dot(ray.direction, map.view.faces[static_cast<std::size_t>(face)].forward));
  }
  Value& at(int column, int row) {
    return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_) +
                   static_cast<std::size_t>(column)];
  }
  const Value& clamped(int column, int row) const {
    return const_cast<BlurredFace*>(this)->at(std::clamp(column, 0, size_ - 1),
                                              std::clamp(row, 0, size_ - 1));
  }
  void blur(int radius, int du, int dv) {
    BlurredFace source = *this;
    for (int row = 0; row < size_; ++row)
      for (int column = 0; column < size_; ++column) {
        Value sum{};
        for (int i = -radius; i <= radius; ++i)
          for (std::size_t k = 0; k < 4; ++k)
            sum[k] += source.clamped(column + i * du, row + i * dv)[k] / (2 * radius + 1);
        at(column, row) = sum;
      }
  }
  int size_;
  std::vector<Value> values_;
};

using judge::chebyshev;
using judge::least_share_before;

}  // namespace gnomon::test
