#include "raster/gl/present.h"

#include <algorithm>

#include "raster/programs/gl_program.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

Viewport overlap(const Viewport& a, const Viewport& b) {
  const int left = std::max(a.x, b.x), low = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width), top = std::min(a.y + a.height, b.y + b.height);
  return {left, low, right - left, top - low};
}

class GlPresenter final : public Presenter {
 public:
  GlPresenter(std::unique_ptr<Gl> gl, Program program)
      : gl_(std::move(gl)), program_(std::move(program)), vertex_array_(*gl_) {}

  std::string renderer() const override { return gl_->text(GL_RENDERER); }

  void clear(const glm::u8vec3& colour) override {
    Gl& gl = *gl_;
    const Vec3f share = Vec3f(colour) / 255.0f;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    for (const GLenum off : {GL_SCISSOR_TEST, GL_FRAMEBUFFER_SRGB}) gl->Disable(off);
    gl->ClearColor(share.r, share.g, share.b, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
  }

  Expected<void> draw(const Rgb8Image& picture, const Viewport& place, const Viewport& clip,
                      Scaling scaling) override {
    const Viewport viewport = overlap(place, clip);
    if (picture.size.pixels() == 0 || viewport.width < 1 || viewport.height < 1) return {};
    Gl& gl = *gl_;
    upload(picture, scaling);
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    gl->Viewport(viewport.x, viewport.y, viewport.width, viewport.height);
    for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST, GL_FRAMEBUFFER_SRGB})
      gl->Disable(off);
    gl->BindVertexArray(vertex_array_.id());
    texture_.bind(shaders::present_unit);
    program_.use();
    gl->ProgramUniform4f(program_.id(), shaders::viewport_uniform, static_cast<float>(place.x),
                         static_cast<float>(place.y), static_cast<float>(place.width),
                         static_cast<float>(place.height));
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    return gl.check("showing the picture");
  }

  Expected<Rgb8Image> read(const Viewport& viewport) override {
    Gl& gl = *gl_;
    Rgb8Image bottom_up({viewport.width, viewport.height});
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    gl->ReadBuffer(GL_BACK);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(viewport.x, viewport.y, viewport.width, viewport.height, GL_RGB, GL_UNSIGNED_BYTE,
                   bottom_up.data.data());
    if (auto ok = gl.check("reading the window back"); !ok) return fail(ok.error());
    Rgb8Image picture(bottom_up.size);
    for (int y = 0; y < viewport.height; ++y)
      std::copy_n(&bottom_up.at(0, viewport.height - 1 - y), viewport.width, &picture.at(0, y));
    return picture;
  }

 private:
  void upload(const Rgb8Image& picture, Scaling scaling) {
    Gl& gl = *gl_;
    if (!texture_ || !(texture_.size() == picture.size)) texture_ = Texture2D(gl, GL_RGB8, picture.size);
    const GLint filter = scaling == Scaling::nearest ? GL_NEAREST : GL_LINEAR;
    gl->TextureParameteri(texture_.id(), GL_TEXTURE_MIN_FILTER, filter);
    gl->TextureParameteri(texture_.id(), GL_TEXTURE_MAG_FILTER, filter);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TextureSubImage2D(texture_.id(), 0, 0, 0, picture.size.width, picture.size.height, GL_RGB,
                          GL_UNSIGNED_BYTE, picture.data.data());
  }

  std::unique_ptr<Gl> gl_;
  Program program_;
  VertexArray vertex_array_;
  Texture2D texture_;
};

}  // namespace

Expected<std::unique_ptr<Presenter>> Presenter::create(Context& context) {
  if (!context.make_current()) return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  auto gl = Gl::load(context);
  if (!gl) return fail(gl.error());
  auto program = Program::link(**gl, "fullscreen.vert", "present.frag", {});
  if (!program) return fail(program.error());
  return std::make_unique<GlPresenter>(std::move(*gl), std::move(*program));
}

}  // namespace gnomon::raster
