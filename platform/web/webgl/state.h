// What WebGL 2 does not keep of the objects that raster/ makes.
#pragma once

#include <GLES3/gl3.h>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "platform/web/webgl/calls.h"
#include "platform/web/webgl/glsl.h"

namespace gnomon::web {

inline constexpr GLenum texture_buffers = 0x8C2A;  // OpenGL's, which WebGL's header has not
inline constexpr GLuint spare_unit = 31;           ///< of textures that are written or read, not drawn with

struct BufferState {
  std::vector<std::uint8_t> bytes{};
  unsigned version = 1, uploaded = 0;
  GLuint gl = 0;
};
struct TextureState {
  GLenum target = 0, format = 0;
  int layers = 0, side = 0, levels = 1;
  GLuint buffer = 0;     ///< of a buffer texture
  unsigned version = 0;  ///< of the buffer's that it holds
  GLuint gl = 0;
};
struct ShaderState {
  GLenum type = 0;
  Bindings bindings{};
};
struct ProgramState {
  std::vector<ShaderState> shaders{};
  std::map<GLint, GLint> location{};  ///< the shaders' number of a uniform, and WebGL's
  std::vector<GLuint> units{};
  GLint first = -1, clip = -1, adds = -1;
};

/// What raster/ has asked for that shaders do where extensions are lacking (Lacks).
struct Asked {
  bool upper_left = false, clamps_depth = false, adds = false;
  GLenum front = GL_CCW;
};

struct State {
  std::map<GLuint, BufferState> buffers{};
  std::map<GLuint, TextureState> textures{};
  std::map<GLuint, ShaderState> shaders{};
  std::map<GLuint, ProgramState> programs{};
  std::map<GLuint, GLuint> unit_texture{}, block_buffer{};
  GLuint next = 1, current = 0;
  Lacks lacks{};
  Asked asked{};
  // What reads textures back (read_back.h), made when it is first needed.
  GLuint depth_program = 0, waiting_framebuffer = 0, waiting_texture = 0;
  GLuint mean_program = 0;  // of fallbacks.cpp
  TextureState before{};
  GLsizei before_width = 0, before_height = 0;
};
State& state();  ///< of the current context

void bind_spare(const TextureState& texture);
/// Makes the 2D texture that stands for a buffer texture hold what the buffer does.
void refresh(TextureState& texture);

/// A function of OpenGL's, of any type.
using Procedure = void (*)();
struct Named {
  const char* name;
  Procedure function;
};
template <class Function>
Named named(const char* name, Function* function) {
  return {name, reinterpret_cast<Procedure>(function)};
}
/// nullptr: none of the name.
Procedure found(std::span<const Named> all, const char* name);
Procedure object_procedure(const char* name);    ///< objects.cpp's
Procedure program_procedure(const char* name);   ///< programs.cpp's
Procedure fallback_procedure(const char* name);  ///< fallbacks.cpp's
/// A program that draws the whole viewport with this fragment shader.
GLuint fullscreen_program(const char* fragment);
/// Draws with such a program, the first row lowest, without any test.
void draw_upright();
/// Tells the current program what is asked of its shaders.
void before_fallback_draw(const ProgramState& program);

}  // namespace gnomon::web
