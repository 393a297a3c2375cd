#include "platform/web/webgl/read_back.h"

#include <emscripten/em_js.h>

#include <array>
#include <cstdint>
#include <vector>

#include "platform/web/webgl/state.h"

namespace gnomon::web {
namespace {

constexpr GLenum green = 0x1904;

/// Copies depths into a texture of floats.
GLuint depth_program() {
  GLuint& made = state().depth_program;
  if (made == 0)
    made = fullscreen_program(R"(#version 300 es
precision highp float;
precision highp sampler2D;
precision highp sampler2DArray;
uniform sampler2DArray layers;
uniform sampler2D flat_map;
uniform ivec4 at;
out float depth;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy) + at.xy;
  depth = at.w == 1 ? texelFetch(layers, ivec3(p, at.z), 0).r : texelFetch(flat_map, p, 0).r;
}
)");
  return made;
}

void draw_depths(const TextureState& texture, const std::array<GLint, 4>& at, GLsizei width, GLsizei height) {
  constexpr GLint layers_unit = 30, flat_unit = 29;
  const GLuint program = depth_program();
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "layers"), layers_unit);
  glUniform1i(glGetUniformLocation(program, "flat_map"), flat_unit);
  glUniform4iv(glGetUniformLocation(program, "at"), 1, at.data());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(texture.layers > 0 ? layers_unit : flat_unit));
  glBindTexture(texture.target, texture.gl);
  glViewport(0, 0, width, height);
  draw_upright();
}

void read_depths(const TextureState& texture, const std::array<GLint, 4>& at, GLsizei width, GLsizei height,
                 float* out) {
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  TextureState floats{.target = GL_TEXTURE_2D};
  glGenTextures(1, &floats.gl);
  bind_spare(floats);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, width, height);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, floats.gl, 0);
  draw_depths(texture, at, width, height);
  std::vector<float> four(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, four.data());
  for (std::size_t i = 0; i < four.size() / 4; ++i) out[i] = four[4 * i];
  glDeleteTextures(1, &floats.gl);
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  if (state().current != 0) glUseProgram(state().current);
}

void read_numbers(GLint x, GLint y, GLsizei width, GLsizei height, GLenum type, void* out) {
  std::vector<GLuint> four(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glReadPixels(x, y, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, four.data());
  for (std::size_t i = 0; i < four.size() / 4; ++i) {
    if (type == GL_UNSIGNED_BYTE)
      static_cast<std::uint8_t*>(out)[i] = static_cast<std::uint8_t>(four[4 * i]);
    else
      static_cast<GLuint*>(out)[i] = four[4 * i];
  }
}

void read_floats(GLint x, GLint y, GLsizei width, GLsizei height, GLenum components, float* out) {
  std::vector<float> four(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glReadPixels(x, y, width, height, GL_RGBA, GL_FLOAT, four.data());
  const std::size_t count = components == GL_RGBA  ? 4
                            : components == GL_RGB ? 3
                            : components == GL_RG  ? 2
                                                   : 1;
  const std::size_t from = components == green ? 1 : 0;
  for (std::size_t i = 0; i < four.size() / 4; ++i)
    for (std::size_t k = 0; k < count; ++k) out[i * count + k] = four[4 * i + from + k];
}

}  // namespace

void read_texture(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei,
                  GLenum components, GLenum type, GLsizei, void* out) {
  const TextureState& texture = state().textures[id];
  GLint was = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &was);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  if (components == GL_DEPTH_COMPONENT) {
    read_depths(texture, {x, y, z, texture.layers > 0 ? 1 : 0}, width, height, static_cast<float*>(out));
  } else {
    if (texture.layers > 0)
      glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.gl, level, z);
    else
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.gl, level);
    if (components == GL_RED_INTEGER)
      read_numbers(x, y, width, height, type, out);
    else
      read_floats(x, y, width, height, components, static_cast<float*>(out));
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(was));
  glDeleteFramebuffers(1, &framebuffer);
}

void finish() {
  GLuint &framebuffer = state().waiting_framebuffer, &texture = state().waiting_texture;
  GLint was = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &was);
  if (framebuffer == 0) {
    glGenFramebuffers(1, &framebuffer);
    glGenTextures(1, &texture);
    bind_spare({.target = GL_TEXTURE_2D, .gl = texture});
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 1, 1);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  std::uint8_t pixel[4];
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(was));
}

}  // namespace gnomon::web
