#include "raster/gl/gl_objects.h"

#include <fmt/core.h>

#include <array>

namespace gnomon::raster {
namespace {

template <class Create>
GLuint created(const Create& create) {
  GLuint id = 0;
  create(&id);
  return id;
}

}  // namespace

Buffer::Buffer(const Gl& gl) : GlObject(gl, created([&](GLuint* id) { gl->CreateBuffers(1, id); })) {}

void Buffer::write_bytes(const void* data, std::size_t size) {
  if (size != 0 && size == size_) {
    gl()->NamedBufferSubData(id(), 0, static_cast<GLsizeiptr>(size), data);
    return;
  }
  // A shader storage block needs some memory behind it even when it holds nothing.
  constexpr std::size_t least = 64;
  size_ = size;
  gl()->NamedBufferData(id(), static_cast<GLsizeiptr>(std::max(size, least)), size < least ? nullptr : data,
                        GL_DYNAMIC_DRAW);
  if (size != 0 && size < least) gl()->NamedBufferSubData(id(), 0, static_cast<GLsizeiptr>(size), data);
}

void Buffer::bind(GLenum target, int binding) const {
  gl()->BindBufferBase(target, static_cast<GLuint>(binding), id());
}

Texture2D::Texture2D(const Gl& gl, GLenum format, ImageSize size, int layers, int levels)
    : GlObject(gl, created([&](GLuint* id) {
                 gl->CreateTextures(layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, 1, id);
               })),
      size_(size),
      layers_(layers),
      levels_(levels),
      format_(format) {
  if (layers > 0) {
    gl->TextureStorage3D(id(), levels, format, size.width, size.height, layers);
  } else {
    gl->TextureStorage2D(id(), levels, format, size.width, size.height);
  }
  gl->TextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl->TextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl->TextureParameteri(id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl->TextureParameteri(id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Texture2D::set_linear_filtering() {
  gl()->TextureParameteri(id(), GL_TEXTURE_MIN_FILTER, levels_ > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  gl()->TextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void Buffer::reserve(std::size_t size) {
  constexpr std::size_t least = 64;  // as in write_bytes()
  size_ = size;
  gl()->NamedBufferData(id(), static_cast<GLsizeiptr>(std::max(size, least)), nullptr, GL_DYNAMIC_DRAW);
}

void* Buffer::map() {
  return gl()->MapNamedBufferRange(id(), 0, static_cast<GLsizeiptr>(size_),
                                   GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
}

void Buffer::unmap() {
  gl()->UnmapNamedBuffer(id());
}

BufferTexture::BufferTexture(const Gl& gl)
    : GlObject(gl, created([&](GLuint* id) { gl->CreateTextures(GL_TEXTURE_BUFFER, 1, id); })) {}

void BufferTexture::attach(const Buffer& buffer, GLenum format) {
  if (buffer.size() == 0) return gl()->TextureBuffer(id(), format, buffer.id());  // a range must not be empty
  gl()->TextureBufferRange(id(), format, buffer.id(), 0, static_cast<GLsizeiptr>(buffer.size()));
}

void BufferTexture::bind(int unit) const {
  gl()->BindTextureUnit(static_cast<GLuint>(unit), id());
}

void Texture2D::bind(int unit) const {
  gl()->BindTextureUnit(static_cast<GLuint>(unit), id());
}

void Texture2D::read(GLenum components, GLenum type, std::span<std::byte> out) const {
  const std::size_t count = static_cast<std::size_t>(std::max(layers_, 1)), bytes = out.size() / count;
  for (std::size_t layer = 0; layer < count; ++layer)
    read_layer(static_cast<int>(layer), {0, size_.height}, components, type,
               out.subspan(layer * bytes, bytes));
}

void Texture2D::read_rows(const PictureRows& rows, GLenum components, GLenum type,
                          std::span<std::byte> out) const {
  read_layer(0, rows, components, type, out);
}

void Texture2D::read_layer(int layer, const PictureRows& rows, GLenum components, GLenum type,
                           std::span<std::byte> out) const {
  constexpr std::size_t most_bytes = std::size_t{1}
                                     << 30;  // the size that OpenGL is told has 32 bits and a sign
  if (rows.count <= 0) return;
  gl()->PixelStorei(GL_PACK_ALIGNMENT, 1);
  const std::size_t row_bytes = out.size() / static_cast<std::size_t>(rows.count);
  const int at_once = static_cast<int>(std::clamp<std::size_t>(
      most_bytes / std::max<std::size_t>(row_bytes, 1), 1, static_cast<std::size_t>(rows.count)));
  for (int row = 0; row < rows.count; row += at_once) {
    const int count = std::min(at_once, rows.count - row);
    const auto part =
        out.subspan(static_cast<std::size_t>(row) * row_bytes, static_cast<std::size_t>(count) * row_bytes);
    gl()->GetTextureSubImage(id(), 0, 0, rows.first + row, layer, size_.width, count, 1, components, type,
                             static_cast<GLsizei>(part.size()), part.data());
  }
}

void Texture2D::write(GLenum components, GLenum type, std::span<const std::byte> texels) {
  gl()->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl()->TextureSubImage2D(id(), 0, 0, 0, size_.width, size_.height, components, type, texels.data());
}

Framebuffer::Framebuffer(const Gl& gl)
    : GlObject(gl, created([&](GLuint* id) { gl->CreateFramebuffers(1, id); })) {}

void Framebuffer::attach(GLenum attachment, const Texture2D& texture, int layer) {
  if (layer < 0) {
    gl()->NamedFramebufferTexture(id(), attachment, texture.id(), 0);
  } else {
    gl()->NamedFramebufferTextureLayer(id(), attachment, texture.id(), 0, layer);
  }
}

void Framebuffer::draw_to(int count) {
  constexpr std::array<GLenum, 4> all{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                                      GL_COLOR_ATTACHMENT3};
  gl()->NamedFramebufferDrawBuffers(id(), count, all.data());
}

void Framebuffer::clear_color(int attachment) const {
  const glm::vec4 zero(0.0f);
  gl()->ClearNamedFramebufferfv(id(), GL_COLOR, attachment, &zero.x);
}

Expected<void> Framebuffer::check_complete() const {
  const GLenum status = gl()->CheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return {};
  return fail(ErrorKind::graphics, fmt::format("the framebuffer cannot be drawn to (status 0x{:x})", status));
}

VertexArray::VertexArray(const Gl& gl)
    : GlObject(gl, created([&](GLuint* id) { gl->CreateVertexArrays(1, id); })) {}

void VertexArray::set_indices(const Buffer& buffer) {
  gl()->VertexArrayElementBuffer(id(), buffer.id());
}

void VertexArray::set_floats(int attribute, const Buffer& buffer, int components, std::uint32_t first) {
  const auto index = static_cast<GLuint>(attribute);
  const auto stride = components * static_cast<GLsizei>(sizeof(float));
  gl()->EnableVertexArrayAttrib(id(), index);
  gl()->VertexArrayAttribFormat(id(), index, components, GL_FLOAT, GL_FALSE, 0);
  gl()->VertexArrayAttribBinding(id(), index, index);
  gl()->VertexArrayVertexBuffer(id(), index, buffer.id(), static_cast<GLintptr>(first) * stride, stride);
}

void VertexArray::set_doubles(int attribute, const Buffer& buffer, int components) {
  const auto index = static_cast<GLuint>(attribute);
  gl()->EnableVertexArrayAttrib(id(), index);
  gl()->VertexArrayAttribLFormat(id(), index, components, GL_DOUBLE, 0);
  gl()->VertexArrayAttribBinding(id(), index, index);
  gl()->VertexArrayVertexBuffer(id(), index, buffer.id(), 0,
                                components * static_cast<GLsizei>(sizeof(double)));
}

}  // namespace gnomon::raster
