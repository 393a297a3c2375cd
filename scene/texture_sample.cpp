#include "scene/texture_sample.h"

namespace gnomon {
namespace {

// The two texels of one axis and the weight of the second.
struct AxisTexels {
  int first, second;
  double weight;
};

int wrap_index(int index, int count, bool repeat) {
  if (!repeat) return std::clamp(index, 0, count - 1);
  const int rest = index % count;
  return rest < 0 ? rest + count : rest;
}

AxisTexels axis_texels(double t, int count, bool repeat, bool nearest) {
  if (!std::isfinite(t)) t = 0.0;
  const double wrapped = repeat ? t - std::floor(t) : std::clamp(t, 0.0, 1.0);
  if (nearest) {
    const int index = wrap_index(static_cast<int>(std::floor(wrapped * count)), count, repeat);
    return {index, index, 0.0};
  }
  const double x = wrapped * count - 0.5;
  const double floor_x = std::floor(x);
  const int index = static_cast<int>(floor_x);
  return {wrap_index(index, count, repeat), wrap_index(index + 1, count, repeat), x - floor_x};
}

Vec4 decode(const Texture& texture, int column, int row) {
  const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.size.width) +
                            static_cast<std::size_t>(column);
  const glm::u8vec4 texel = texture.texels[index];
  const double alpha = texel.a / 255.0;
  if (!texture.srgb) return {texel.r / 255.0, texel.g / 255.0, texel.b / 255.0, alpha};
  const auto& linear = linear_from_srgb8();
  return {linear[texel.r], linear[texel.g], linear[texel.b], alpha};
}

double decode_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

const std::array<float, 256>& linear_from_srgb8() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(decode_srgb(static_cast<double>(i) / 255.0));
    return values;
  }();
  return table;
}

Vec2 transform_uv(const TextureTransform& transform, const Vec2& uv) {
  const Vec2 scaled = transform.scale * uv;
  if (transform.rotation == 0.0) return transform.offset + scaled;
  const double c = std::cos(transform.rotation);
  const double s = std::sin(transform.rotation);
  return transform.offset + Vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

Vec4f sample_texture(const Texture& texture, const Vec2& uv) {
  const AxisTexels u = axis_texels(uv.x, texture.size.width, texture.repeat_s, texture.nearest);
  const AxisTexels v = axis_texels(uv.y, texture.size.height, texture.repeat_t, texture.nearest);
  if (texture.nearest) return Vec4f(decode(texture, u.first, v.first));
  const Vec4 top = glm::mix(decode(texture, u.first, v.first), decode(texture, u.second, v.first), u.weight);
  const Vec4 bottom =
      glm::mix(decode(texture, u.first, v.second), decode(texture, u.second, v.second), u.weight);
  return Vec4f(glm::mix(top, bottom, v.weight));
}

}  // namespace gnomon
