// One context's OpenGL 4.5 functions and its error messages. Private to raster: no public header includes
// this.
#pragma once

#include <glad/gl.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "raster/context.h"

namespace gnomon::raster {

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
  /// A folder whose files take the place of those of the same name in shaders/; empty: none.
  const std::string& shader_folder() const { return shader_folder_; }
  void set_shader_folder(std::string folder) { shader_folder_ = std::move(folder); }

  GLint integer(GLenum name) const;
  std::string text(GLenum name) const;
  /// Error (graphics) when OpenGL reported one since the last check: "`what`: its words".
  Expected<void> check(std::string_view what);

 private:
  Gl() = default;
  static void GLAD_API_PTR on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar* message, const void* self);
  GladGLContext api_{};
  std::vector<std::string> messages_;
  std::string shader_folder_;
};

/// Side of the largest square depth map: the least of texture and viewport limits.
int max_map_size(const Gl& gl);

}  // namespace gnomon::raster
