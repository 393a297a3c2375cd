// Shaders, programs, their uniforms, and what is drawn with them.
#include <algorithm>

#include "platform/web/webgl/glsl.h"
#include "platform/web/webgl/state.h"

namespace gnomon::web {
namespace {

// --- Programs ---

GLuint create_program() {
  const GLuint id = glCreateProgram();
  state().programs[id] = {};
  return id;
}
void delete_program(GLuint id) {
  glDeleteProgram(id);
  state().programs.erase(id);
}
GLuint create_shader(GLenum type) {
  const GLuint id = glCreateShader(type);
  state().shaders[id] = {.type = type};
  return id;
}
void delete_shader(GLuint id) {
  glDeleteShader(id);
  state().shaders.erase(id);
}
void shader_source(GLuint id, GLsizei, const GLchar* const* text, const GLint*) {
  ShaderState& shader = state().shaders[id];
  Translation es =
      to_es(text[0], shader.type == GL_VERTEX_SHADER ? Stage::vertex : Stage::fragment, state().lacks);
  const char* chars = es.text.c_str();
  glShaderSource(id, 1, &chars, nullptr);
  shader.bindings = std::move(es.bindings);
}
void attach_shader(GLuint program, GLuint shader) {
  glAttachShader(program, shader);
  state().programs[program].shaders.push_back(state().shaders[shader]);
}
GLuint compiled(GLenum type, const char* text) {
  const GLuint shader = glCreateShader(type);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}
/// A program of a vertex shader alone writes depths; here it needs a second one.
void attach_empty_fragment(GLuint program) {
  const GLuint shader = compiled(GL_FRAGMENT_SHADER, depth_only(state().lacks).data());
  glAttachShader(program, shader);
  glDeleteShader(shader);
}
void link_program(GLuint id) {
  ProgramState& program = state().programs[id];
  if (std::ranges::none_of(program.shaders,
                           [](const ShaderState& s) { return s.type == GL_FRAGMENT_SHADER; }))
    attach_empty_fragment(id);
  glLinkProgram(id);
  glUseProgram(id), state().current = id;
  for (const ShaderState& shader : program.shaders) {
    for (const auto& [location, name] : shader.bindings.locations)
      program.location[location] = glGetUniformLocation(id, name.c_str());
    for (const auto& [unit, name] : shader.bindings.samplers)
      if (const GLint at = glGetUniformLocation(id, name.c_str()); at >= 0) {
        glUniform1i(at, unit);
        program.units.push_back(static_cast<GLuint>(unit));
      }
    for (const auto& [binding, name] : shader.bindings.blocks)
      if (const GLuint at = glGetUniformBlockIndex(id, name.c_str()); at != GL_INVALID_INDEX)
        glUniformBlockBinding(id, at, static_cast<GLuint>(binding));
  }
  program.first = glGetUniformLocation(id, "gnomon_first");
  program.clip = glGetUniformLocation(id, "gnomon_clip");
  program.adds = glGetUniformLocation(id, "gnomon_adds");
}
void use_program(GLuint id) {
  glUseProgram(id), state().current = id;
}
GLint location_in(GLuint program, GLint location) {
  if (state().current != program) use_program(program);
  const auto& known = state().programs[program].location;
  const auto found = known.find(location);
  return found == known.end() ? -1 : found->second;
}
void uniform_1i(GLuint p, GLint l, GLint v) {
  glUniform1i(location_in(p, l), v);
}
void uniform_1ui(GLuint p, GLint l, GLuint v) {
  glUniform1ui(location_in(p, l), v);
}
void uniform_2i(GLuint p, GLint l, GLint a, GLint b) {
  glUniform2i(location_in(p, l), a, b);
}
void uniform_2f(GLuint p, GLint l, GLfloat a, GLfloat b) {
  glUniform2f(location_in(p, l), a, b);
}
void uniform_4f(GLuint p, GLint l, GLfloat a, GLfloat b, GLfloat c, GLfloat d) {
  glUniform4f(location_in(p, l), a, b, c, d);
}
void uniform_4fv(GLuint p, GLint l, GLsizei n, const GLfloat* v) {
  glUniform4fv(location_in(p, l), n, v);
}
void uniform_matrix(GLuint p, GLint l, GLsizei n, GLboolean transpose, const GLfloat* v) {
  glUniformMatrix4fv(location_in(p, l), n, transpose, v);
}

// --- Drawing ---

void before_draw() {
  const ProgramState& program = state().programs[state().current];
  before_fallback_draw(program);
  for (const GLuint unit : program.units) {
    const auto found = state().textures.find(state().unit_texture[unit]);
    if (found == state().textures.end()) continue;
    TextureState& texture = found->second;
    if (texture.target == texture_buffers) refresh(texture);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(texture.target == texture_buffers ? GL_TEXTURE_2D : texture.target, texture.gl);
  }
  for (const auto& [at, id] : state().block_buffer) {
    BufferState& buffer = state().buffers[id];
    if (buffer.bytes.empty()) continue;
    if (buffer.gl == 0) glGenBuffers(1, &buffer.gl);
    if (buffer.uploaded != buffer.version) {
      glBindBuffer(GL_UNIFORM_BUFFER, buffer.gl);
      glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(buffer.bytes.size()), buffer.bytes.data(),
                   GL_DYNAMIC_DRAW);
      buffer.uploaded = buffer.version;
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, at, buffer.gl);
  }
}
void draw_arrays(GLenum mode, GLint first, GLsizei count) {
  before_draw();
  glDrawArrays(mode, first, count);
}
/// Triangles by their number: the shader fetches the indices (glsl.h).
void draw_elements(GLenum mode, GLsizei count, GLenum, const void* offset) {
  constexpr std::uintptr_t triangle_bytes = 12;
  before_draw();
  glUniform1i(state().programs[state().current].first,
              static_cast<GLint>(reinterpret_cast<std::uintptr_t>(offset) / triangle_bytes));
  glDrawArrays(mode, 0, count);
}

}  // namespace

GLuint fullscreen_program(const char* fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compiled(GL_VERTEX_SHADER, R"(#version 300 es
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0);
}
)"));
  glAttachShader(program, compiled(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(program);
  return program;
}

Procedure program_procedure(const char* name) {
  static const Named all[] = {
      named("glCreateProgram", create_program),  named("glDeleteProgram", delete_program),
      named("glCreateShader", create_shader),    named("glDeleteShader", delete_shader),
      named("glShaderSource", shader_source),    named("glCompileShader", glCompileShader),
      named("glAttachShader", attach_shader),    named("glLinkProgram", link_program),
      named("glUseProgram", use_program),        named("glProgramUniform1i", uniform_1i),
      named("glProgramUniform1ui", uniform_1ui), named("glProgramUniform2i", uniform_2i),
      named("glProgramUniform2f", uniform_2f),   named("glProgramUniform4f", uniform_4f),
      named("glProgramUniform4fv", uniform_4fv), named("glProgramUniformMatrix4fv", uniform_matrix),
      named("glDrawArrays", draw_arrays),        named("glDrawElements", draw_elements),
  };
  return found(all, name);
}

}  // namespace gnomon::web
