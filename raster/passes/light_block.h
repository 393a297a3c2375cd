// What the shaders know of a light and its map: the twin of shaders/light_map.glsl's uniform block. Private
// to raster.
#pragma once

#include <array>

#include "raster/frame.h"
#include "scene/light_map/light_view.h"
#include "scene/world.h"

namespace gnomon::raster {

struct LightBlock {
  std::array<Vec4f, 6> right, up, forward, origin_and_warp, extent_and_depths;
  Vec4f origin_and_size, bias, direction_and_cos_outer, intensity_and_cone;
  Vec4f rounding;
  glm::ivec4 counts;
  Vec4f area_u, area_v, filter_radii, moments;
};

LightBlock make_light_block(const Light& light, const LightView& view, const MapOptions& map,
                            double constant_world, const BiasRounding& rounding, const Vec3& reference);

/// What rounding leaves of the map's biases.
BiasRounding bias_rounding(const MapOptions& map, const LightView& view, const World& world,
                           const Vec3& reference);

}  // namespace gnomon::raster
