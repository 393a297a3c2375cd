// Textures read back. WebGL 2 reads colours alone, four components a pixel, and depth not at all.
#pragma once

#include <GLES3/gl3.h>

namespace gnomon::web {

/// glGetTextureSubImage() of one layer.
void read_texture(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei,
                  GLenum components, GLenum type, GLsizei, void* out);

/// Waits until all is drawn: WebGL's own finish() does not, but what is read must be there.
void finish();

}  // namespace gnomon::web
