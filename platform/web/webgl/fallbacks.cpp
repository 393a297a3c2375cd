// Clip control, clamped depths, blended and filtered floats: by WebGL's extensions where it has them, else by the shaders
// (glsl.h, Lacks), with what they need from here.
#include <emscripten/em_js.h>

#include <algorithm>
#include <cstdlib>

#include "platform/web/webgl/state.h"

EM_JS_DEPS(gnomon_fallbacks, "$stringToNewUTF8");
EM_JS(int, gnomon_has_extension, (const char* name),
      { return GLctx.getExtension(UTF8ToString(name)) ? 1 : 0; });
EM_JS(void, gnomon_clip_control, (int origin, int depth),
      { GLctx.getExtension("EXT_clip_control").clipControlEXT(origin, depth); });
EM_JS(void, gnomon_enablei, (int what, int index),
      { GLctx.getExtension("OES_draw_buffers_indexed").enableiOES(what, index); });

namespace gnomon::web {
namespace {

// OpenGL's, which WebGL's header has not.
constexpr GLenum depth_clamp = 0x864F, lower_left = 0x8CA1, upper_left = 0x8CA2, minus_one_to_one = 0x935E,
                 framebuffer_srgb = 0x8DB9, debug_output = 0x92E0, debug_at_once = 0x8242;

// --- Clip control and clamped depths ---

/// With y turned by the shader, what was seen anticlockwise is seen clockwise.
void set_front_face() {
  const Asked& asked = state().asked;
  const bool turned = state().lacks.clip_control && asked.upper_left;
  glFrontFace(!turned ? asked.front : asked.front == GL_CCW ? GL_CW : GL_CCW);
}
void clip_control(GLenum origin, GLenum depth) {
  if (!state().lacks.clip_control)
    return gnomon_clip_control(static_cast<int>(origin), static_cast<int>(depth));
  state().asked.upper_left = origin == upper_left;
  set_front_face();
}
void front_face(GLenum front) {
  state().asked.front = front;
  set_front_face();
}

void switch_to(GLenum what, bool on) {
  if (what == debug_output || what == debug_at_once || what == framebuffer_srgb) return;  // WebGL has none
  if (what == depth_clamp && state().lacks.clip_control) return void(state().asked.clamps_depth = on);
  if (what == GL_BLEND && state().lacks.float_blend) return void(state().asked.adds = on);
  on ? glEnable(what) : glDisable(what);
}
void enable(GLenum what) {
  switch_to(what, true);
}
void disable(GLenum what) {
  switch_to(what, false);
}

// --- Lights that add up ---

void enable_indexed(GLenum what, GLuint at) {
  if (state().lacks.float_blend) return enable(what);
  gnomon_enablei(static_cast<int>(what), static_cast<int>(at));
}

/// Makes `texture` one of `format` that is `width` x `height` and that shaders fetch from.
void make_fetched(TextureState& texture, GLenum format, GLsizei width, GLsizei height) {
  glDeleteTextures(1, &texture.gl);
  glGenTextures(1, &texture.gl);
  texture.target = GL_TEXTURE_2D, texture.format = format;
  bind_spare(texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

/// Keeps what the picture holds where the shader reads it: a picture cannot be read while it is drawn.
void keep_picture() {
  TextureState& before = state().before;
  GLint viewport[4] = {0, 0, 1, 1};
  if (state().asked.adds) glGetIntegerv(GL_VIEWPORT, viewport);
  GLsizei &width = state().before_width, &height = state().before_height;
  if (width < viewport[2] || height < viewport[3]) {
    width = std::max(width, viewport[2]), height = std::max(height, viewport[3]);
    make_fetched(before, GL_RGBA32F, width, height);
  }
  bind_spare(before);
  if (state().asked.adds) glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, viewport[2], viewport[3]);
  glActiveTexture(GL_TEXTURE0 + before_unit);
  glBindTexture(GL_TEXTURE_2D, before.gl);
}

// --- Mipmaps of floats ---

/// Halves a level: the mean of four texels where its size is even.
GLuint mean_program() {
  GLuint& made = state().mean_program;
  if (made == 0) {
    std::string text = "#version 300 es\nprecision highp float;\nprecision highp sampler2DArray;\n";
    text += bilinear;
    text += R"(
uniform sampler2DArray layers;
uniform ivec3 at;  // layer, the level that is halved, and how many texels it becomes
out vec4 mean;
void main() {
  mean = gnomon_bilinear(layers, vec3(gl_FragCoord.xy / float(at.z), at.x), at.y);
}
)";
    made = fullscreen_program(text.c_str());
  }
  return made;
}

/// Each level the one below filtered, as drivers have it (of odd sizes, too), drawn beside the texture and copied into it.
void halve_floats(const TextureState& texture) {
  TextureState half;
  GLint viewport[4], was = 0;
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &was);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glUseProgram(mean_program());
  for (GLint level = 1; level < texture.levels; ++level) {
    const GLsizei side = std::max(1, texture.side >> level);
    make_fetched(half, texture.format, side, side);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, half.gl, 0);
    glViewport(0, 0, side, side);
    bind_spare(texture);
    glUniform1i(glGetUniformLocation(mean_program(), "layers"), spare_unit);
    for (GLint layer = 0; layer < texture.layers; ++layer) {
      glUniform3i(glGetUniformLocation(mean_program(), "at"), layer, level - 1, side);
      draw_upright();
      glCopyTexSubImage3D(texture.target, level, 0, 0, layer, 0, 0, side, side);
    }
  }
  glDeleteTextures(1, &half.gl);
  glDeleteFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(was));
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  if (state().current != 0) glUseProgram(state().current);
}
void generate_mipmap(GLuint id) {
  const TextureState& texture = state().textures[id];
  if (state().lacks.float_linear) return halve_floats(texture);  // of moments: no others have mipmaps
  bind_spare(texture);
  glGenerateMipmap(texture.target);
}

}  // namespace

std::string use_extensions() {
  const auto has = [](const char* name) { return gnomon_has_extension(name) != 0; };
  state().lacks = {.clip_control = !has("EXT_clip_control") || !has("EXT_depth_clamp"),
                   .float_blend = !has("EXT_float_blend") || !has("OES_draw_buffers_indexed"),
                   .float_linear = !has("OES_texture_float_linear")};
  constexpr const char* needed = "EXT_color_buffer_float";
  return has(needed) ? "" : needed;
}

void draw_upright() {
  if (!state().lacks.clip_control) gnomon_clip_control(lower_left, minus_one_to_one);
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) glDisable(off);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void before_fallback_draw(const ProgramState& program) {
  const Asked& asked = state().asked;
  if (program.clip >= 0)
    glUniform2f(program.clip, asked.upper_left ? -1.0f : 1.0f, asked.clamps_depth ? 1.0f : 0.0f);
  if (program.adds < 0) return;
  glUniform1i(program.adds, asked.adds ? 1 : 0);
  keep_picture();
}

Procedure fallback_procedure(const char* name) {
  static const Named all[] = {
      named("glClipControl", clip_control),
      named("glFrontFace", front_face),
      named("glEnable", enable),
      named("glDisable", disable),
      named("glEnablei", enable_indexed),
      named("glGenerateTextureMipmap", generate_mipmap),
  };
  return found(all, name);
}

}  // namespace gnomon::web
