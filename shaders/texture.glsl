// Texture lookup by texelFetch with the same arithmetic as scene/texture_sample.h; the driver's filter is never used.
// The texels of all textures follow one another in the layers ("pages") of one array texture.

struct TextureData {
  uint first_texel;
  uint width;
  uint height;
  uint flags;
};

layout(binding = textures_unit) uniform usamplerBuffer texture_texels;
layout(binding = texel_pages_unit) uniform usampler2DArray texel_pages;

TextureData texture_at(uint index) {
  uvec4 t = texelFetch(texture_texels, srgb_texel_count + int(index));
  return TextureData(t.x, t.y, t.z, t.w);
}

float linear_from_srgb8(uint value) { return uintBitsToFloat(texelFetch(texture_texels, int(value)).x); }

vec4 decoded_texel(TextureData image, int column, int row) {
  uint index = image.first_texel + uint(row) * image.width + uint(column);
  ivec3 at = ivec3(index % uint(page_width), (index / uint(page_width)) % uint(page_height),
                   index / uint(page_width * page_height));
  uvec4 texel = texelFetch(texel_pages, at, 0);
  vec4 linear = vec4(texel) / 255.0;
  if ((image.flags & uint(texture_srgb)) != 0u)
    linear.rgb = vec3(linear_from_srgb8(texel.r), linear_from_srgb8(texel.g), linear_from_srgb8(texel.b));
  return linear;
}

int wrap_index(int index, int count, bool repeat) {
  if (!repeat) return clamp(index, 0, count - 1);
  return index < 0 ? index + count : (index >= count ? index - count : index);
}

// The two texels of one axis, and the weight of the second.
ivec2 axis_texels(float t, int count, bool repeat, bool nearest, out float weight) {
  if (isnan(t) || isinf(t)) t = 0.0;
  float wrapped = repeat ? t - floor(t) : clamp(t, 0.0, 1.0);
  weight = 0.0;
  if (nearest) return ivec2(wrap_index(int(floor(wrapped * float(count))), count, repeat));
  float x = wrapped * float(count) - 0.5;
  int index = int(floor(x));
  weight = x - floor(x);
  return ivec2(wrap_index(index, count, repeat), wrap_index(index + 1, count, repeat));
}

vec4 sample_texture(uint id, vec2 uv) {
  TextureData image = texture_at(id);
  bool nearest = (image.flags & uint(texture_nearest)) != 0u;
  vec2 weight;
  ivec2 u = axis_texels(uv.x, int(image.width), (image.flags & uint(texture_repeat_s)) != 0u, nearest, weight.x);
  ivec2 v = axis_texels(uv.y, int(image.height), (image.flags & uint(texture_repeat_t)) != 0u, nearest, weight.y);
  vec4 top = mix(decoded_texel(image, u.x, v.x), decoded_texel(image, u.y, v.x), weight.x);
  vec4 bottom = mix(decoded_texel(image, u.x, v.y), decoded_texel(image, u.y, v.y), weight.x);
  return mix(top, bottom, weight.y);
}
