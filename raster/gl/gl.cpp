#define GLAD_GL_IMPLEMENTATION
#include "raster/gl/gl.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "raster/programs/shader_folder.h"

namespace gnomon::raster {
namespace {

GLADapiproc load_procedure(void* context, const char* name) {
  return static_cast<const Context*>(context)->procedure(name);
}

std::string_view error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "incomplete framebuffer";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return "unknown error";
  }
}

}  // namespace

Gl::Gl() : shader_folder_(std::make_unique<ShaderFolder>()) {}

void GLAD_API_PTR Gl::on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message,
                                 const void* self) {
  if (type != GL_DEBUG_TYPE_ERROR) return;
  static_cast<Gl*>(const_cast<void*>(self))->messages_.emplace_back(message);
}

Expected<std::unique_ptr<Gl>> Gl::load(const Context& context) {
  std::unique_ptr<Gl> gl(new Gl);
  const int version = gladLoadGLContextUserPtr(&gl->api_, load_procedure, const_cast<Context*>(&context));
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    return fail(ErrorKind::graphics, fmt::format("OpenGL 4.5 is needed (got {}.{})",
                                                 GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version)));
  }
  gl->api_.Enable(GL_DEBUG_OUTPUT);
  gl->api_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl->api_.DebugMessageCallback(on_message, gl.get());
  return gl;
}

Gl::~Gl() {
  if (api_.DebugMessageCallback != nullptr) api_.DebugMessageCallback(nullptr, nullptr);
}

GLint Gl::integer(GLenum name) const {
  GLint value = 0;
  api_.GetIntegerv(name, &value);
  return value;
}

std::string Gl::text(GLenum name) const {
  const GLubyte* value = api_.GetString(name);
  return value == nullptr ? std::string() : reinterpret_cast<const char*>(value);
}

Expected<void> Gl::check(std::string_view what) {
  std::string reason;
  const auto add = [&](std::string_view part) {
    reason += reason.empty() ? "" : "; ";
    reason += part;
  };
  constexpr int most = 16;  // a lost context may report for ever
  for (int i = 0; i < most; ++i) {
    const GLenum error = api_.GetError();
    if (error == GL_NO_ERROR) break;
    add(error_name(error));
  }
  for (const std::string& message : messages_) add(message);
  messages_.clear();
  if (reason.empty()) return {};
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
  return fail(ErrorKind::graphics, fmt::format("{}: OpenGL says: {}", what, reason));
}

int max_map_size(const Gl& gl) {
  std::array<GLint, 2> viewport{};
  gl->GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return std::min({gl.integer(GL_MAX_TEXTURE_SIZE), viewport[0], viewport[1]});
}

}  // namespace gnomon::raster
