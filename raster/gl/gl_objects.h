// OpenGL objects that clean up after themselves. The context must be current whenever one is made, used or
// destroyed. Private to raster.
#pragma once

#include <span>
#include <utility>

#include "raster/gl/gl.h"
#include "scene/image.h"

namespace gnomon::raster {

enum class GlKind { buffer, texture, framebuffer, vertex_array, program };

/// Owns one object name of the given kind.
template <GlKind kind>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(const Gl& gl, GLuint id) : gl_(&gl), id_(id) {}
  GlObject(GlObject&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject() { destroy(); }

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 protected:
  const Gl& gl() const { return *gl_; }

 private:
  void destroy() {
    if (id_ == 0) return;
    const Gl& g = *gl_;
    if constexpr (kind == GlKind::buffer) g->DeleteBuffers(1, &id_);
    if constexpr (kind == GlKind::texture) g->DeleteTextures(1, &id_);
    if constexpr (kind == GlKind::framebuffer) g->DeleteFramebuffers(1, &id_);
    if constexpr (kind == GlKind::vertex_array) g->DeleteVertexArrays(1, &id_);
    if constexpr (kind == GlKind::program) g->DeleteProgram(id_);
  }
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
};

/// Data on the device, replaced as a whole by write().
class Buffer : public GlObject<GlKind::buffer> {
 public:
  Buffer() = default;
  explicit Buffer(const Gl& gl);
  template <class T>
  void write(std::span<const T> values) {
    write_bytes(values.data(), values.size_bytes());
  }
  template <class T>
  void write_one(const T& value) {
    write_bytes(&value, sizeof(T));
  }
  /// So many bytes, of no particular value.
  void reserve(std::size_t size);
  /// `count` values that put(span) writes where they will lie: nothing is held twice.
  template <class T, class Put>
  void fill(std::size_t count, const Put& put) {
    reserve(count * sizeof(T));
    void* at = count > 0
                   ? map()
                   : nullptr;  // none where memory was short: the caller's next look at GL's errors says so
    if (at == nullptr) return;
    put(std::span<T>(static_cast<T*>(at), count));
    unmap();
  }
  std::size_t size() const { return size_; }
  void bind(GLenum target, int binding) const;

 private:
  void write_bytes(const void* data, std::size_t size);
  void* map();
  void unmap();
  std::size_t size_ = 0;
};

/// What shaders read of a buffer through a sampler: more than a storage block may hold.
class BufferTexture : public GlObject<GlKind::texture> {
 public:
  BufferTexture() = default;
  explicit BufferTexture(const Gl& gl);
  /// Reads the buffer as texels of this format (GL_RGB32F ...), as long as both live.
  void attach(const Buffer& buffer, GLenum format);
  void bind(int unit) const;
};

/// A 2D texture, or a 2D array texture when layers > 0; nearest filtering, clamped to the edge.
class Texture2D : public GlObject<GlKind::texture> {
 public:
  Texture2D() = default;
  Texture2D(const Gl& gl, GLenum format, ImageSize size, int layers = 0, int levels = 1);
  /// Linear within a level and between levels.
  void set_linear_filtering();
  void bind(int unit) const;
  ImageSize size() const { return size_; }
  int layers() const { return layers_; }
  int levels() const { return levels_; }
  GLenum format() const { return format_; }
  /// All texels of level 0, all layers, row 0 first, tightly packed.
  void read(GLenum components, GLenum type, std::span<std::byte> out) const;
  /// Reads some rows of level 0 of a 2D texture.
  void read_rows(const PictureRows& rows, GLenum components, GLenum type, std::span<std::byte> out) const;
  /// Replaces all texels of a 2D texture.
  void write(GLenum components, GLenum type, std::span<const std::byte> texels);

 private:
  void read_layer(int layer, const PictureRows& rows, GLenum components, GLenum type,
                  std::span<std::byte> out) const;

  ImageSize size_;
  int layers_ = 0, levels_ = 1;
  GLenum format_ = 0;
};

class Framebuffer : public GlObject<GlKind::framebuffer> {
 public:
  Framebuffer() = default;
  explicit Framebuffer(const Gl& gl);
  /// layer < 0: the whole (non-array) texture.
  void attach(GLenum attachment, const Texture2D& texture, int layer = -1);
  /// The color attachments 0 ... count-1 are drawn to.
  void draw_to(int count);
  Expected<void> check_complete() const;
  /// Fills a colour attachment with zeros. Memory that was asked for is there when it is first written: whoever times
  /// what is drawn next does this before.
  void clear_color(int attachment = 0) const;
};

class VertexArray : public GlObject<GlKind::vertex_array> {
 public:
  VertexArray() = default;
  explicit VertexArray(const Gl& gl);
  void set_indices(const Buffer& buffer);
  /// Binds vertices from 0 on to the buffer's elements from `first` on, of so many components.
  void set_floats(int attribute, const Buffer& buffer, int components, std::uint32_t first = 0);
  void set_doubles(int attribute, const Buffer& buffer, int components);
};

}  // namespace gnomon::raster
