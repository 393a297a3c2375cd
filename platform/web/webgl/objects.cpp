// Buffers, buffer textures, textures and framebuffers.
#include <algorithm>
#include <cstring>

#include "platform/web/webgl/glsl.h"
#include "platform/web/webgl/state.h"

namespace gnomon::web {

void bind_spare(const TextureState& texture) {
  glActiveTexture(GL_TEXTURE0 + spare_unit);
  glBindTexture(texture.target == texture_buffers ? GL_TEXTURE_2D : texture.target, texture.gl);
}

namespace {

TextureState& texture_of(GLuint id) {
  return state().textures[id];
}

// --- Buffers and buffer textures ---

struct TexelFormat {
  GLenum components, type;
  std::size_t bytes;
};
TexelFormat format_of(GLenum format) {
  switch (format) {
    case GL_RGB32F:
      return {GL_RGB, GL_FLOAT, 12};
    case GL_RG32F:
      return {GL_RG, GL_FLOAT, 8};
    case GL_RGBA32F:
      return {GL_RGBA, GL_FLOAT, 16};
    case GL_RGB32UI:
      return {GL_RGB_INTEGER, GL_UNSIGNED_INT, 12};
    case GL_RG32UI:
      return {GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
    case GL_R32UI:
      return {GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    default:
      return {GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
  }
}

}  // namespace

void refresh(TextureState& texture) {
  BufferState& buffer = state().buffers[texture.buffer];
  if (texture.version == buffer.version) return;
  const TexelFormat format = format_of(texture.format);
  const int count = std::max(1, static_cast<int>(buffer.bytes.size() / format.bytes));
  const int width = std::min(count, fetch_width), height = (count + width - 1) / width;
  std::vector<std::uint8_t> whole(buffer.bytes);
  whole.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * format.bytes);
  glDeleteTextures(1, &texture.gl);
  glGenTextures(1, &texture.gl);
  bind_spare(texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexStorage2D(GL_TEXTURE_2D, 1, texture.format, width, height);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format.components, format.type, whole.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  texture.version = buffer.version;
}

namespace {

void create_buffers(GLsizei n, GLuint* ids) {
  for (int i = 0; i < n; ++i) ids[i] = state().next++, state().buffers[ids[i]];
}
void delete_buffers(GLsizei n, const GLuint* ids) {
  for (int i = 0; i < n; ++i) {
    if (const GLuint gl = state().buffers[ids[i]].gl; gl != 0) glDeleteBuffers(1, &gl);
    state().buffers.erase(ids[i]);
  }
}
void named_buffer_data(GLuint id, GLsizeiptr size, const void* data, GLenum) {
  BufferState& buffer = state().buffers[id];
  buffer.bytes.assign(static_cast<std::size_t>(size), 0);
  if (data != nullptr) std::memcpy(buffer.bytes.data(), data, static_cast<std::size_t>(size));
  ++buffer.version;
}
void named_buffer_sub_data(GLuint id, GLintptr at, GLsizeiptr size, const void* data) {
  BufferState& buffer = state().buffers[id];
  std::memcpy(buffer.bytes.data() + at, data, static_cast<std::size_t>(size));
  ++buffer.version;
}
void* map_named_buffer_range(GLuint id, GLintptr at, GLsizeiptr, GLbitfield) {
  return state().buffers[id].bytes.data() + at;
}
GLboolean unmap_named_buffer(GLuint id) {
  ++state().buffers[id].version;
  return GL_TRUE;
}
void bind_buffer_base(GLenum target, GLuint at, GLuint id) {
  if (target == GL_UNIFORM_BUFFER) state().block_buffer[at] = id;
}

// --- Textures ---

void create_textures(GLenum target, GLsizei n, GLuint* ids) {
  for (int i = 0; i < n; ++i) {
    TextureState texture{.target = target};
    glGenTextures(1, &texture.gl);
    ids[i] = state().next++;
    state().textures[ids[i]] = texture;
  }
}
void delete_textures(GLsizei n, const GLuint* ids) {
  for (int i = 0; i < n; ++i) {
    glDeleteTextures(1, &texture_of(ids[i]).gl);
    state().textures.erase(ids[i]);
  }
}
void texture_storage_2d(GLuint id, GLsizei levels, GLenum format, GLsizei width, GLsizei height) {
  texture_of(id).format = format;
  bind_spare(texture_of(id));
  glTexStorage2D(GL_TEXTURE_2D, levels, format, width, height);
}
void texture_storage_3d(GLuint id, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                        GLsizei layers) {
  texture_of(id).format = format;
  texture_of(id).layers = layers, texture_of(id).side = width, texture_of(id).levels = levels;
  bind_spare(texture_of(id));
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, levels, format, width, height, layers);
}
bool is_float(GLenum format) {
  return format == GL_R32F || format == GL_RG32F || format == GL_RGBA32F;
}
/// Of what shaders filter by themselves: WebGL reads nothing of a texture that it should filter and cannot.
GLint unfiltered(GLint value) {
  return value == GL_LINEAR                 ? GL_NEAREST
         : value == GL_LINEAR_MIPMAP_LINEAR ? GL_NEAREST_MIPMAP_NEAREST
                                            : value;
}
void texture_parameter(GLuint id, GLenum name, GLint value) {
  bind_spare(texture_of(id));
  if (state().lacks.float_linear && is_float(texture_of(id).format)) value = unfiltered(value);
  glTexParameteri(texture_of(id).target, name, value);
}
void texture_buffer(GLuint id, GLenum format, GLuint buffer) {
  TextureState& texture = texture_of(id);
  texture.format = format, texture.buffer = buffer, texture.version = 0;
}
void texture_buffer_range(GLuint id, GLenum format, GLuint buffer, GLintptr, GLsizeiptr) {
  texture_buffer(id, format, buffer);
}
void bind_texture_unit(GLuint unit, GLuint id) {
  state().unit_texture[unit] = id;
}
void texture_sub_image_2d(GLuint id, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                          GLenum components, GLenum type, const void* texels) {
  bind_spare(texture_of(id));
  glTexSubImage2D(GL_TEXTURE_2D, level, x, y, width, height, components, type, texels);
}
void texture_sub_image_3d(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                          GLsizei depth, GLenum components, GLenum type, const void* texels) {
  bind_spare(texture_of(id));
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, x, y, z, width, height, depth, components, type, texels);
}

// --- Framebuffers ---

void framebuffer_texture(GLuint id, GLenum at, GLuint texture, GLint level) {
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferTexture2D(GL_FRAMEBUFFER, at, GL_TEXTURE_2D, texture_of(texture).gl, level);
}
void framebuffer_layer(GLuint id, GLenum at, GLuint texture, GLint level, GLint layer) {
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferTextureLayer(GL_FRAMEBUFFER, at, texture_of(texture).gl, level, layer);
}
void framebuffer_draw_buffers(GLuint id, GLsizei n, const GLenum* buffers) {
  constexpr GLenum none = GL_NONE;
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  n > 0 ? glDrawBuffers(n, buffers) : glDrawBuffers(1, &none);
}
void framebuffer_parameter(GLuint, GLenum, GLint) {}  // a size without attachments: izb's alone
GLenum framebuffer_status(GLuint id, GLenum) {
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  return glCheckFramebufferStatus(GL_FRAMEBUFFER);
}
void clear_floats(GLuint id, GLenum buffer, GLint at, const GLfloat* value) {
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glClearBufferfv(buffer, at, value);
}
void clear_numbers(GLuint id, GLenum buffer, GLint at, const GLuint* value) {
  const GLuint four[4] = {value[0], 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glClearBufferuiv(buffer, at, four);
}

}  // namespace

Procedure object_procedure(const char* name) {
  static const Named all[] = {
      named("glCreateBuffers", create_buffers),
      named("glDeleteBuffers", delete_buffers),
      named("glNamedBufferData", named_buffer_data),
      named("glNamedBufferSubData", named_buffer_sub_data),
      named("glMapNamedBufferRange", map_named_buffer_range),
      named("glUnmapNamedBuffer", unmap_named_buffer),
      named("glBindBufferBase", bind_buffer_base),
      named("glCreateTextures", create_textures),
      named("glDeleteTextures", delete_textures),
      named("glTextureStorage2D", texture_storage_2d),
      named("glTextureStorage3D", texture_storage_3d),
      named("glTextureParameteri", texture_parameter),
      named("glTextureBuffer", texture_buffer),
      named("glTextureBufferRange", texture_buffer_range),
      named("glBindTextureUnit", bind_texture_unit),
      named("glTextureSubImage2D", texture_sub_image_2d),
      named("glTextureSubImage3D", texture_sub_image_3d),
      named("glNamedFramebufferTexture", framebuffer_texture),
      named("glNamedFramebufferTextureLayer", framebuffer_layer),
      named("glNamedFramebufferDrawBuffers", framebuffer_draw_buffers),
      named("glNamedFramebufferParameteri", framebuffer_parameter),
      named("glCheckNamedFramebufferStatus", framebuffer_status),
      named("glClearNamedFramebufferfv", clear_floats),
      named("glClearNamedFramebufferuiv", clear_numbers),
      named("glBindFramebuffer", glBindFramebuffer),
      named("glPixelStorei", glPixelStorei),
  };
  return found(all, name);
}

}  // namespace gnomon::web
