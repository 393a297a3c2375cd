#include "raster/light_block.h"

namespace gnomon::raster {

LightBlock make_light_block(const Light& light, const LightView& view, const Bias& bias,
                            double constant_world, const Vec3& reference) {
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
  block.bias = Vec4f(Vec4(constant_world, bias.slope, bias.normal_offset_texels, 0.0));
  const double cos_outer = std::cos(light.outer_angle);
  const double ramp = std::max(1e-9, std::cos(light.inner_angle) - cos_outer);  // as in scene/light.cpp
  block.direction_and_cos_outer = Vec4f(Vec4(light.direction, cos_outer));
  block.intensity_and_cone = Vec4f(light.intensity, static_cast<float>(1.0 / ramp));
  block.counts = glm::ivec4(view.face_count, 0, 0, 0);
  return block;
}

}  // namespace gnomon::raster
