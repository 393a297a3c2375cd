// One context's OpenGL 4.5 functions and its error messages. Private to raster: no public header includes
// this.
#pragma once

#include <glad/gl.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "raster/gl/context.h"

namespace gnomon::raster {

class ShaderFolder;

class Gl {
 public:
  /// Loads the functions of the current context and turns its debug messages on.
  /// Error (graphics): it is older than 4.5, or a function is missing.
  static Expected<std::unique_ptr<Gl>> load(const Context& context);
  Gl(const Gl&) = delete;
  Gl& operator=(const Gl&) = delete;
  /// The context must be current: its messages go nowhere from here on.
  ~Gl();

  const GladGLContext* operator->() const { return &api_; }
  /// The files that take the place of those of the same name in shaders/, and which of them are in use.
  ShaderFolder& shader_folder() const { return *shader_folder_; }

  GLint integer(GLenum name) const;
  std::string text(GLenum name) const;
  /// Error (graphics) when OpenGL reported one since the last check: "`what`: its words".
  Expected<void> check(std::string_view what);

 private:
  Gl();
  static void GLAD_API_PTR on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar* message, const void* self);
  GladGLContext api_{};
  std::vector<std::string> messages_;
  std::unique_ptr<ShaderFolder> shader_folder_;
};

/// Side of the largest square depth map: the least of texture and viewport limits.
int max_map_size(const Gl& gl);

}  // namespace gnomon::raster
