#include "raster/passes/light_block.h"

#include "raster/passes/technique_pass.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::raster {
LightBlock make_light_block(const Light& light, const LightView& view, const MapOptions& map,
                            double constant_world, const BiasRounding& rounding, const Vec3& reference) {
  LightBlock block{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(view.face_count); ++i) {
    block.right[i] = Vec4f(Vec4(view.faces[i].right, 0.0));
    block.up[i] = Vec4f(Vec4(view.faces[i].up, 0.0));
    block.forward[i] = Vec4f(Vec4(view.faces[i].forward, 0.0));
    block.origin_and_warp[i] = Vec4f(Vec4(face_origin(view, view.faces[i]) - reference, view.faces[i].warp));
    block.extent_and_depths[i] =
        Vec4f(Vec4(view.faces[i].half_extent, view.faces[i].near_depth, view.faces[i].far_depth));
  }
  block.origin_and_size = Vec4f(Vec4(view.origin - reference, view.size));
  block.bias = Vec4f(Vec4(constant_world, map.bias.slope, map.bias.normal_offset_texels, 0.0));
  const double cos_outer = std::cos(light.outer_angle);
  block.direction_and_cos_outer = Vec4f(Vec4(light.direction, cos_outer));
  block.intensity_and_cone = Vec4f(light.intensity, static_cast<float>(1.0 / spot_ramp(light)));
  block.rounding = Vec4f(Vec4(rounding.float_world, rounding.stored_step, rounding.adaptive_epsilon_world,
                              rounding.constant_texel_world));
  block.counts = glm::ivec4(view.face_count, 0, 0, 0);
  const ShaderArea area = shape_shader_area(light.extent, view.faces[0]);
  block.area_u = Vec4f(Vec4(area.u, 0.0));
  block.area_v = Vec4f(Vec4(area.v, 0.0));
  const FilterOptions& f = map.filter;
  block.filter_radii =
      Vec4f(Vec4(f.radius_texels, search_radius_texels(map), f.light_bleeding_reduction, map.cascades.blend));
  if (const auto moments = traits_of(map.technique).drawing->moments) block.moments = Vec4f(moments(f));
  return block;
}

}  // namespace gnomon::raster
