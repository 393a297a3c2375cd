// A shader of the program in the language of WebGL 2: GLSL 4.50 as shaders/ is written, in GLSL ES 3.00. Lines keep their
// numbers, so that errors name those of the original.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace gnomon::web {

/// Width in texels of the 2D textures that stand for buffer textures.
inline constexpr int fetch_width = 2048;

enum class Stage : bool { vertex, fragment };

/// What GLSL ES 3.00 cannot say in a layout: to be set when the program is linked, by name.
struct Bindings {
  std::map<int, std::string> locations, samplers, blocks;
};

struct Translation {
  std::string text;
  Bindings bindings;
};

/// Of a whole stage, its includes in place, that uses neither doubles nor storage buffers.
Translation to_es(std::string_view text, Stage stage);

}  // namespace gnomon::web
