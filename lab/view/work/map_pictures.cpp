#include "lab/view/work/worker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/result/palette.h"
#include "scene/base/parallel.h"

namespace gnomon::lab {

namespace {

constexpr glm::u8vec3 unseen{60, 62, 66};

template <class Function>
Rgb8Image picture(ImageSize size, const Function& colour_of) {
  Rgb8Image image(size);
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) image.at(x, y) = colour_of(x, y);
  });
  return image;
}

glm::u8vec3 rounded(const Vec3f& colour) {
  return glm::u8vec3(glm::clamp(colour, 0.0f, 255.0f) + 0.5f);
}

/// These colours tell faces or cascades apart (Okabe & Ito 2008).
constexpr std::array<Vec3f, 6> tints{Vec3f{0xe6, 0x9f, 0x00}, Vec3f{0x56, 0xb4, 0xe9},
                                     Vec3f{0x00, 0x9e, 0x73}, Vec3f{0xf0, 0xe4, 0x42},
                                     Vec3f{0xcc, 0x79, 0xa7}, Vec3f{0xd5, 0x5e, 0x00}};

/// Texels from one pixel to its neighbour, the larger of both ways; infinite at the ends of a face.
double texels_per_pixel(const raster::LightRecord& record, int x, int y) {
  const Image<Vec2f>& uv = record.texel_uv;
  const Vec2f here = uv.at(x, y);
  double most = 0.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
    const int nx = x + dx < uv.size.width ? x + dx : x - dx, ny = y + dy < uv.size.height ? y + dy : y - dy;
    if (nx < 0 || ny < 0) continue;
    const Vec2f there = uv.at(nx, ny) - here;
    most = std::max(most, static_cast<double>(std::max(std::abs(there.x), std::abs(there.y))));
  }
  return most;
}

}  // namespace

Rgb8Image truth_picture(const compare::LightComparison& light) {
  const Image<float>& truth = light.rungs.front();
  return picture(truth.size, [&](int x, int y) {
    return compare::is_compared(light.labels.at(x, y)) ? rounded(Vec3f(255.0f * truth.at(x, y))) : unseen;
  });
}

Rgb8Image gap_picture(const raster::LightRecord& record, const compare::LightComparison& light) {
  const double texel = record.texel_world;
  return picture(light.labels.size, [&](int x, int y) {
    if (!compare::is_compared(light.labels.at(x, y))) return unseen;
    const double gap = record.gap.at(x, y);
    const double share = texel > 0.0 ? std::clamp(gap / texel / gap_scale_texels, -1.0, 1.0) : 0.0;
    const glm::u8vec3 end = share < 0.0 ? compare::missed_shadow_colour : compare::false_shadow_colour;
    return rounded(glm::mix(Vec3f(255.0f), Vec3f(end), static_cast<float>(std::abs(share))));
  });
}

Rgb8Image texel_picture(const Rgb8Image& drawn, const raster::LightRecord& record,
                        const compare::LightComparison& light) {
  return picture(drawn.size, [&](int x, int y) {
    const glm::u8vec3 own = drawn.at(x, y);
    const float luma = 0.2126f * own.r + 0.7152f * own.g + 0.0722f * own.b;
    const Vec3f grey(40.0f + 0.7f * luma);
    if (light.labels.at(x, y) == compare::Label::background || record.outside_map.at(x, y) != 0)
      return rounded(grey);
    const Vec2f uv = record.texel_uv.at(x, y);
    const auto parity = (static_cast<int>(std::floor(uv.x)) + static_cast<int>(std::floor(uv.y))) & 1;
    const double fine = texels_per_pixel(record, x, y);
    const auto strength = static_cast<float>(std::clamp(2.0 - 2.0 * fine, 0.0, 1.0));
    const Vec3f tint = record.map.view.face_count > 1 ? tints[record.face.at(x, y) % tints.size()] : tints[1];
    const Vec3f base = glm::mix(grey, tint * (luma / 255.0f * 0.7f + 0.3f), 0.35f);
    return rounded(base * (1.0f + strength * (parity != 0 ? 0.28f : -0.28f)));
  });
}

}  // namespace gnomon::lab
