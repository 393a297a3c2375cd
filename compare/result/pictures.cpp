// The pictures of a comparison as 8-bit sRGB images, row 0 at the top. Pixel-wise work runs on oneTBB, row by
// row.

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "scene/base/parallel.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::compare {
namespace {

template <class Function>
Rgb8Image picture(ImageSize size, const Function& colour_of) {
  Rgb8Image image(size);
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) image.at(x, y) = colour_of(image.index(x, y));
  });
  return image;
}

// How far a stored depth lies through the map's range: 0 at its near end, 1 at its far end. Even in depth for
// an orthographic map; in its logarithm for a perspective one, whose range may span several powers of ten.
double depth_share(const LightView& view, int face, int row, float stored) {
  const double depth = depth_from_stored(view, face, row + 0.5, static_cast<double>(stored));
  const Interval range = view.depth_range();
  if (view.projection == LightProjection::perspective)
    return std::log(depth / range.min) / std::log(range.max / range.min);
  return (depth - range.min) / (range.max - range.min);
}

}  // namespace

Rgb8Image raster_picture(const Comparison& c) {
  return display_image(c.raster.color, c.exposure);
}

Rgb8Image raytraced_picture(const Comparison& c) {
  return display_image(c.raytraced.color, c.exposure);
}

Rgb8Image difference_picture(const Comparison& c, const LightComparison& light) {
  return difference_picture(raster_picture(c), light);
}

Rgb8Image difference_picture(const Rgb8Image& drawn, const LightComparison& light) {
  const Image<float>& v0 = light.rungs[static_cast<std::size_t>(Rung::truth)];
  const Image<float>& v6 = light.rungs[static_cast<std::size_t>(Rung::drawn)];
  return picture(drawn.size, [&](std::size_t i) {
    const glm::u8vec3 grey = grey_backdrop(drawn.data[i]);
    const float difference = v6.data[i] - v0.data[i];
    if (!is_compared(light.labels.data[i]) || difference == 0.0f) return grey;
    const glm::u8vec3 error = difference < 0.0f ? false_shadow_colour : missed_shadow_colour;
    return glm::u8vec3(glm::mix(Vec3f(grey), Vec3f(error), std::min(std::abs(difference), 1.0f)) + 0.5f);
  });
}

glm::u8vec3 label_pixel(Label label, bool truly_dark, float error) {
  const glm::u8vec3 right = truly_dark ? right_in_shadow_colour : label_colour(Label::right);
  if (!has_cause(label)) return label == Label::right ? right : label_colour(label);
  return glm::u8vec3(glm::mix(Vec3f(right), Vec3f(label_colour(label)), std::min(error, 1.0f)) + 0.5f);
}

Rgb8Image label_picture(const LightComparison& light) {
  const Image<float>& truth = light.rungs[static_cast<std::size_t>(Rung::truth)];
  const Image<float>& drawn = light.rungs[static_cast<std::size_t>(Rung::drawn)];
  return picture(light.labels.size, [&](std::size_t i) {
    return label_pixel(light.labels.data[i], truth.data[i] < 0.5f, std::abs(drawn.data[i] - truth.data[i]));
  });
}

Rgb8Image error_picture(const LightComparison& light) {
  const Image<float>& truth = light.rungs.front();
  const Image<float>& drawn = light.rungs.back();
  return picture(light.labels.size, [&](std::size_t i) {
    return magma(is_compared(light.labels.data[i]) ? std::abs(double{drawn.data[i]} - double{truth.data[i]})
                                                   : 0.0);
  });
}

Rgb8Image flip_picture(const LightComparison& light) {
  return picture(light.flip_map.size, [&](std::size_t i) { return magma(double{light.flip_map.data[i]}); });
}

Rgb8Image ssim_picture(const LightComparison& light) {
  return picture(light.ssim_map.size,
                 [&](std::size_t i) { return magma(1.0 - double{light.ssim_map.data[i]}); });
}

Rgb8Image decision_picture(const Comparison& c, const LightComparison& light) {
  constexpr std::array tints{surely_shadowed_colour, surely_lit_colour};
  constexpr float strength = 0.3f;
  const Rgb8Image drawn = raster_picture(c);
  const Image<std::uint8_t>& decision = drawn_record(c, light).external->decision;
  return picture(drawn.size, [&](std::size_t i) {
    const auto who = static_cast<raster::Decision>(decision.data[i]);
    if (who == raster::Decision::traced) return traced_colour;
    const glm::u8vec3 grey = grey_backdrop(drawn.data[i]);
    if (who == raster::Decision::not_asked) return grey;
    const Vec3f tint(tints[static_cast<std::size_t>(who)]);
    return glm::u8vec3(glm::mix(Vec3f(grey), tint, strength) + 0.5f);
  });
}

Rgb8Image edge_picture(const LightComparison& light) {
  const Image<float>& truth = light.rungs.front();
  return picture(light.edge_map.size, [&](std::size_t i) {
    const float texels = light.edge_map.data[i];
    if (std::isnan(texels))
      return is_compared(light.labels.data[i]) ? glm::u8vec3(truth.data[i] > 0.5f ? 0x50 : 0x30)
                                               : glm::u8vec3(0);
    const glm::u8vec3 colour = texels > 0.0f ? false_shadow_colour : missed_shadow_colour;
    const double share = std::min(std::abs(double{texels}) / edge_scale_texels, 1.0);
    return glm::u8vec3(glm::mix(Vec3f(255.0f), Vec3f(colour), static_cast<float>(share)) + 0.5f);
  });
}

Rgb8Image detachment_picture(const LightComparison& light) {
  const double texel = light.texel_world[1];
  return picture(light.detachment_map.size, [&](std::size_t i) {
    const double world = double{light.detachment_map.data[i]};
    return std::isnan(world) || !(texel > 0.0) ? glm::u8vec3(0)
                                               : magma(world / texel / detachment_scale_texels);
  });
}

Rgb8Image depth_map_picture(const raster::ShadowMap& map) {
  const int n = map.view.size, faces = map.view.face_count;
  const int across = std::min(faces, 3), down = (faces + across - 1) / across;  // +x -x +y over -y +z -z
  const int gap = faces > 1 ? std::max(1, n / 64) : 0;
  Rgb8Image image({across * n + (across - 1) * gap, down * n + (down - 1) * gap}, nothing_stored_colour);
  parallel_for(faces * n, [&](int line) {
    const int face = line / n, row = line % n;
    const int left = (face % across) * (n + gap), top = (face / across) * (n + gap);
    for (int column = 0; column < n; ++column) {
      const float stored = map.depth[map.texel_index(face, column, row)];
      if (holds_caster(map.view, stored))
        image.at(left + column, top + n - 1 - row) = viridis(1.0 - depth_share(map.view, face, row, stored));
    }
  });
  return image;
}

}  // namespace gnomon::compare
