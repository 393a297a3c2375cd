// A shader of the program in the language of WebGL 2: GLSL 4.50 as shaders/ is written, in GLSL ES 3.00. Lines keep their
// numbers, so that errors name those of the original.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace gnomon::web {

/// Width in texels of the 2D textures that stand for buffer textures.
inline constexpr int fetch_width = 2048;
/// The texture unit of what a picture held before a light is added to it, where float_blend is lacking.
inline constexpr int before_unit = 28;

/// The extensions that a context has not, each of which shaders then do without (docs/platforms.md).
struct Lacks {
  bool clip_control =
      false;  ///< EXT_clip_control or EXT_depth_clamp: the fragments write what they would store
  bool float_blend = false;   ///< EXT_float_blend or OES_draw_buffers_indexed: the shader adds what was there
  bool float_linear = false;  ///< OES_texture_float_linear: the shader filters
};

/// A function that filters a level of a texture of floats, whose edge repeats.
inline constexpr std::string_view bilinear = R"(vec4 gnomon_bilinear(sampler2DArray s, vec3 p, int level) {
  ivec2 last = textureSize(s, level).xy - 1;
  vec2 at = p.xy * vec2(last + 1) - 0.5, share = fract(at);
  ivec2 low = clamp(ivec2(floor(at)), ivec2(0), last), high = clamp(ivec2(floor(at)) + 1, ivec2(0), last);
  int layer = int(p.z + 0.5);
  return mix(mix(texelFetch(s, ivec3(low, layer), level), texelFetch(s, ivec3(high.x, low.y, layer), level), share.x),
             mix(texelFetch(s, ivec3(low.x, high.y, layer), level), texelFetch(s, ivec3(high, layer), level), share.x), share.y);
}
)";

enum class Stage : bool { vertex, fragment };

/// What GLSL ES 3.00 cannot say in a layout: to be set when the program is linked, by name.
struct Bindings {
  std::map<int, std::string> locations, samplers, blocks;
};

struct Translation {
  std::string text;
  Bindings bindings;
};

/// Translates a whole stage, its includes in place, that uses neither doubles nor storage buffers.
Translation to_es(std::string_view text, Stage stage, const Lacks& lacks);
/// The fragment shader of a program that writes depths alone.
std::string_view depth_only(const Lacks& lacks);

}  // namespace gnomon::web
