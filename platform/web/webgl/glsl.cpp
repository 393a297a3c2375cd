#include "platform/web/webgl/glsl.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "shaders/shared_constants.h"

namespace gnomon::web {
namespace {

/// What all stages begin with: precisions, and functions that GLSL ES 3.00 lacks. `gnomon_fetch` reads a buffer texture.
constexpr std::string_view head = R"(#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp sampler2DArray;
precision highp usampler2DArray;
#define gnomon_fetch(s, i) texelFetch(s, ivec2((i) & 2047, (i) >> 11), 0)
float ldexp(float x, int n) {
  int half_n = n / 2;
  return x * uintBitsToFloat(uint(half_n + 127) << 23) * uintBitsToFloat(uint(n - half_n + 127) << 23);
}
float frexp(float x, out int n) {
  uint bits = floatBitsToUint(x);
  n = int(bits >> 23 & 255u) - 126;
  return uintBitsToFloat((bits & 0x807fffffu) | 0x3f000000u);
}
vec4 textureGather(sampler2DArray s, vec3 p) {
  ivec2 size = textureSize(s, 0).xy, at = ivec2(floor(p.xy * vec2(size) - 0.5));
  ivec2 low = clamp(at, ivec2(0), size - 1), high = clamp(at + 1, ivec2(0), size - 1);
  int layer = int(p.z + 0.5);
  return vec4(texelFetch(s, ivec3(low.x, high.y, layer), 0).r, texelFetch(s, ivec3(high, layer), 0).r,
              texelFetch(s, ivec3(high.x, low.y, layer), 0).r, texelFetch(s, ivec3(low, layer), 0).r);
}
)";

/// In the place of the language's own function, where floats are not filtered.
constexpr std::string_view trilinear = R"(vec4 gnomon_trilinear(sampler2DArray s, vec3 p, float level) {
  vec4 below = gnomon_bilinear(s, p, int(level));
  return fract(level) > 0.0 ? mix(below, gnomon_bilinear(s, p, int(level) + 1), fract(level)) : below;
}
#define textureLod gnomon_trilinear
)";

/// What a fragment's depth is where WebGL clips and stores as OpenGL does by default: as by GL_ZERO_TO_ONE. z / w of the clip
/// space is linear on the screen, as depths are, and neither shifted nor scaled on the way.
constexpr std::string_view depth_in = "in vec2 gnomon_zw;\n#define gnomon_z (gnomon_zw.x / gnomon_zw.y)\n",
                           depth_begin = "gl_FragDepth = clamp(gnomon_z, 0.0, 1.0);";
/// Vertices for that: y to the side of `gnomon_clip.x`; between the planes of near and far, or, where those clamp
/// (`gnomon_clip.y`), cut by neither.
constexpr std::string_view depth_out = "uniform vec2 gnomon_clip;\nout vec2 gnomon_zw;\n", depth_end = R"(
  gnomon_zw = gl_Position.zw;
  gl_Position.y *= gnomon_clip.x;
  gl_Position.z = gnomon_clip.y > 0.0 ? 0.0 : 2.0 * gl_Position.z - gl_Position.w;)";

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// layout(std140, binding = camera_block): the numbers, by the constants' names or as they stand.
struct Layout {
  int location = -1, binding = -1;
  bool block = false;
};

class Translator {
 public:
  Translator(std::string_view text, Stage stage, const Lacks& lacks) : stage_(stage), lacks_(lacks) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines_.emplace_back(text.substr(at, end - at));
      at = end + 1;
    }
  }

  Translation run() {
    for (const std::string& line : lines_) {
      note_constant(line);
      if (line.starts_with("#version")) continue;
      body_ += line.starts_with("layout(") ? declaration(line) : line;
      body_ += '\n';
    }
    replace_all(body_, "precise ", "");
    for (const std::string& name : fetched_) {
      replace_all(body_, fmt::format("texelFetch({},", name), fmt::format("gnomon_fetch({},", name));
      replace_all(body_, fmt::format("textureSize({})", name),
                  fmt::format("(textureSize({0}, 0).x * textureSize({0}, 0).y)", name));
    }
    out_.text = head;
    if (lacks_.float_linear && body_.find("textureLod(") != body_.npos)
      out_.text += bilinear, out_.text += trilinear;
    if (adds_) out_.text += "uniform sampler2D gnomon_before;\nuniform int gnomon_adds;\n";
    name_primitives();
    if (pulls_) pull_vertices();
    if (lacks_.clip_control && stage_ == Stage::vertex) out_.text += depth_out, end_ += depth_end;
    surround_main();
    out_.text += body_;
    return std::move(out_);
  }

 private:
  void note_constant(std::string_view line) {
    constexpr std::string_view begin = "const int ";
    const std::size_t equals = line.find('=');
    if (!line.starts_with(begin) || equals == line.npos) return;
    constants_[trimmed(line.substr(begin.size(), equals - begin.size()))] =
        std::atoi(line.data() + equals + 1);
  }

  int number(const std::string& text) const {
    const auto known = constants_.find(text);
    return known != constants_.end() ? known->second : std::atoi(text.c_str());
  }

  Layout layout_of(std::string_view inside) const {
    Layout out;
    while (!inside.empty()) {
      const std::size_t end = std::min(inside.find(','), inside.size()),
                        equals = inside.substr(0, end).find('=');
      if (equals == inside.npos) {
        out.block = true;
      } else {
        int& field = trimmed(inside.substr(0, equals)) == "location" ? out.location : out.binding;
        field = number(trimmed(inside.substr(equals + 1, end - equals - 1)));
      }
      inside.remove_prefix(std::min(end + 1, inside.size()));
    }
    return out;
  }

  /// "uniform samplerBuffer positions[4];  // why": its name.
  static std::string name_in(std::string_view declared) {
    const std::size_t end = declared.find_first_of(";["), begin = declared.rfind(' ', end);
    return std::string(declared.substr(begin + 1, end - begin - 1));
  }

  std::string declaration(const std::string& line) {
    const std::size_t close = line.find(')');
    const Layout layout = layout_of(std::string_view(line).substr(7, close - 7));
    std::string rest = trimmed(std::string_view(line).substr(close + 1));
    if (layout.block) {
      out_.bindings.blocks[layout.binding] = trimmed(rest.substr(8, rest.find('{') - 8));
      return "layout(std140) " + rest;
    }
    if (rest.starts_with("uniform ")) {
      const std::string name = name_in(rest);
      (layout.binding >= 0 ? out_.bindings.samplers[layout.binding]
                           : out_.bindings.locations[layout.location]) = name;
      if (rest.find("samplerBuffer ") != rest.npos) fetched_.push_back(name);
      replace_all(rest, "samplerBuffer ", "sampler2D ");
      return rest;
    }
    if (rest.starts_with("out ") && stage_ == Stage::fragment) return color_output(layout.location, rest);
    if (rest.starts_with("in ") && stage_ == Stage::vertex) {  // an attribute
      pulls_ = true;
      return {};
    }
    return rest;
  }

  std::string color_output(int location, const std::string& rest) {
    if (lacks_.float_blend && name_in(rest) == "radiance") {
      adds_ = true;
      out_.bindings.samplers[before_unit] = "gnomon_before";
      end_ += "if (gnomon_adds != 0) radiance += texelFetch(gnomon_before, ivec2(gl_FragCoord.xy), 0);";
    }
    return fmt::format("layout(location = {}) {}", location, rest);
  }

  /// gl_PrimitiveID comes from the vertices, which know it as their own number.
  void name_primitives() {
    if (stage_ != Stage::fragment || body_.find("gl_PrimitiveID") == body_.npos) return;
    replace_all(body_, "gl_PrimitiveID", "int(gnomon_primitive)");
    out_.text += "flat in uint gnomon_primitive;\n";
    if (!lacks_.clip_control) return;
    out_.text += depth_in, begin_ += depth_begin;
    replace_all(body_, "gl_FragCoord.z", "gnomon_z");
  }

  /// Vertices are fetched by their number, three of them a triangle that no other has: so each knows its triangle. What is
  /// fetched is declared behind the shader's own #defines, which say what there is.
  void pull_vertices() {
    constexpr std::string_view fetch = R"(uniform usampler2D gnomon_triangles;
uniform sampler2D gnomon_positions;
uniform int gnomon_first;
flat out uint gnomon_primitive;
vec3 position;
#ifdef ALPHA_MASK
uniform sampler2D gnomon_uvs;
vec2 uv;
#ifdef VERTEX_COLORS
uniform sampler2D gnomon_colors;
vec4 color;
#endif
#endif
void gnomon_pull() {
  int t = gl_VertexID / 3;
  gnomon_primitive = uint(t);
  int v = int(gnomon_fetch(gnomon_triangles, gnomon_first + t)[gl_VertexID - 3 * t]);
  position = gnomon_fetch(gnomon_positions, v).xyz;
#ifdef ALPHA_MASK
  uv = gnomon_fetch(gnomon_uvs, v).xy;
#ifdef VERTEX_COLORS
  color = gnomon_fetch(gnomon_colors, v);
#endif
#endif
}
)";
    out_.bindings.samplers[shaders::triangles_unit] = "gnomon_triangles";
    out_.bindings.samplers[shaders::positions_unit] = "gnomon_positions";
    out_.bindings.samplers[shaders::uvs_unit] = "gnomon_uvs";
    out_.bindings.samplers[shaders::colors_unit] = "gnomon_colors";
    if (const std::size_t first_line = body_.find("#line "); first_line != body_.npos)
      body_.insert(first_line, fetch);
    begin_ += "gnomon_pull();";
  }

  /// What comes before the shader's own main() and after it, whichever way that returns.
  void surround_main() {
    if (begin_.empty() && end_.empty()) return;
    replace_all(body_, "void main() {", "void gnomon_main() {");
    body_ += fmt::format("void main() {{ {} gnomon_main(); {} }}\n", begin_, end_);
  }

  Stage stage_;
  Lacks lacks_;
  std::vector<std::string> lines_, fetched_;
  std::map<std::string, int> constants_;
  bool pulls_ = false, adds_ = false;
  std::string body_, begin_, end_;
  Translation out_;
};

}  // namespace

Translation to_es(std::string_view text, Stage stage, const Lacks& lacks) {
  return Translator(text, stage, lacks).run();
}

std::string_view depth_only(const Lacks& lacks) {
  static const std::string none = "#version 300 es\nprecision highp float;\nvoid main() {}\n";
  static const std::string written =
      fmt::format("#version 300 es\nprecision highp float;\n{}void main() {{ {} }}\n", depth_in, depth_begin);
  return lacks.clip_control ? written : none;
}

}  // namespace gnomon::web
