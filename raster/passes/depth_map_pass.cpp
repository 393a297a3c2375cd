#include "raster/passes/depth_map_pass.h"

#include <fmt/core.h>

#include <array>

#include "raster/passes/impostors.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

GLenum gl_format(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16:
      return GL_DEPTH_COMPONENT16;
    case DepthFormat::d24:
      return GL_DEPTH_COMPONENT24;
    case DepthFormat::d32f:
    case DepthFormat::d32f_reversed:
      break;
  }
  return GL_DEPTH_COMPONENT32F;
}

bool face_warps(const LightView& view) {
  return view.face(0).warp != 0.0;
}

}  // namespace

Expected<void> DepthMapPass::prepare(const LightView& view, DepthFormat format) {
  Gl& gl = *gl_;
  const ImageSize size{view.size, view.size};
  const bool same = depth_ && depth_.size() == size && depth_.layers() == view.face_count &&
                    depth_.format() == gl_format(format);
  if (same && !faces_.empty()) return {};
  faces_.clear();
  depth_ = Texture2D();
  depth_ = Texture2D(gl, gl_format(format), size, view.face_count);
  const std::string what =
      fmt::format("a depth map of {0} x {0} texels, {1} face(s)", view.size, view.face_count);
  if (auto ok = gl.check(what); !ok) return ok;
  std::vector<Framebuffer> faces;
  for (int i = 0; i < view.face_count; ++i) {
    Framebuffer& face = faces.emplace_back(gl);
    face.attach(GL_DEPTH_ATTACHMENT, depth_, i);
    face.draw_to(0);
    if (auto ok = face.check_complete(); !ok) return ok;
  }
  if (auto ok = gl.check(what); !ok) return ok;
  faces_ = std::move(faces);
  for (int face = 0; face < view.face_count; ++face)
    clear(view, face);  // no timed drawing is the first to touch the memory
  return {};
}

void DepthMapPass::clear(const LightView& view, int face) const {
  const float depth = view.reversed ? 0.0f : shaders::map_clear_depth;
  (*gl_)->ClearNamedFramebufferfv(faces_[static_cast<std::size_t>(face)].id(), GL_DEPTH, 0, &depth);
}

// The viewport is the whole map's in a small drawing, too: casters fall where they belong, and few texels keep them.
void DepthMapPass::set_state(const LightView& view, Cull cull, ImageSize drawn) const {
  const Gl& gl = *gl_;
  gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // row 0 of the map is the lowest v
  gl->Viewport(0, 0, view.size, view.size);
  gl->Disable(GL_BLEND);
  gl->Scissor(0, 0, drawn.width, drawn.height);
  drawn == depth_.size() ? gl->Disable(GL_SCISSOR_TEST) : gl->Enable(GL_SCISSOR_TEST);
  gl->Enable(GL_DEPTH_TEST);
  gl->DepthMask(GL_TRUE);
  gl->DepthFunc(view.reversed ? GL_GREATER : GL_LESS);
  gl->Enable(GL_DEPTH_CLAMP);  // a caster before the near depth is stored at it rather than cut away
  if (cull == Cull::none) {
    gl->Disable(GL_CULL_FACE);
  } else {
    gl->Enable(GL_CULL_FACE);
    gl->CullFace(cull == Cull::front ? GL_FRONT : GL_BACK);
  }
}

float DepthMapPass::format_step() const {
  const int bits = depth_.format() == GL_DEPTH_COMPONENT16 ? 16 : 23;
  return std::exp2(-static_cast<float>(bits));
}

Expected<void> DepthMapPass::draw(const WorldBuffers& world, const LightView& view, Cull cull,
                                  const CasterBias& bias, const DepthMapPass* first) {
  const Gl& gl = *gl_;
  const Drawing drawing{view, cull, bias, first != nullptr};
  const bool biased = bias.moves_casters();
  const auto programs =
      programs_->triangles({.peel = drawing.peel,
                            .reversed = (drawing.peel || biased) && view.reversed,
                            .caster_bias = biased,
                            .perspective = biased && view.projection == LightProjection::perspective,
                            .warp = biased && face_warps(view)});
  if (!programs) return fail(programs.error());
  world.bind();
  set_state(view, cull, world.drawn_part(depth_.size()));
  std::array<GLint, 4> viewport{};
  gl->GetIntegerv(GL_VIEWPORT, viewport.data());
  if (viewport[2] != view.size || viewport[3] != view.size)
    return fail(ErrorKind::graphics, fmt::format("map size: the viewport was cut to {} x {} (got {} texels)",
                                                 viewport[2], viewport[3], view.size));
  if (first != nullptr) first->bind(shaders::first_layer_unit);
  for (int face = 0; face < view.face_count; ++face) {
    if (first != nullptr) programs->set_peel(face, format_step());
    if (biased) programs->set_caster_bias(bias, face);
    const Framebuffer& framebuffer = faces_[static_cast<std::size_t>(face)];
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    clear(view, face);
    world.draw_triangles(*programs, light_clip_from_relative(view, face, world.reference()),
                         WorldBuffers::Drawn::casters);
    gl->Disable(GL_CULL_FACE);
    if (auto ok = draw_shapes(world, drawing, face); !ok) return ok;
    if (cull != Cull::none) gl->Enable(GL_CULL_FACE);
  }
  gl->Disable(GL_SCISSOR_TEST);
  return {};
}

Expected<void> DepthMapPass::draw_shapes(const WorldBuffers& buffers, const Drawing& drawing, int face) {
  const LightView& view = drawing.view;
  const Projection projection = face_projection(view, face);
  return draw_impostors(*gl_, *programs_, buffers.world(), projection, projection.frame,
                        {.camera = false,
                         .perspective = view.projection == LightProjection::perspective,
                         .warp = face_warps(view),
                         .reversed = view.reversed,
                         .peel = drawing.peel,
                         .caster_bias = drawing.bias.moves_casters()},
                        [&](const ImpostorProgram& program) {
                          program.set_face(face, drawing.cull);
                          if (drawing.peel) program.set_peel(face, format_step());
                          if (drawing.bias.moves_casters()) program.set_caster_bias(drawing.bias, face);
                        });
}

void DepthMapPass::read(std::vector<float>& depth) const {
  const std::size_t texels = depth_.size().pixels() * static_cast<std::size_t>(depth_.layers());
  depth.resize(texels);
  depth_.read(GL_DEPTH_COMPONENT, GL_FLOAT, std::as_writable_bytes(std::span(depth)));
}

void DepthMapPass::bind_for_lookup() const {
  depth_.bind(shaders::depth_map_unit);
}

std::uint64_t DepthMapPass::bytes() const {
  const std::uint64_t texel = depth_.format() == GL_DEPTH_COMPONENT16 ? 2 : 4;
  return texel * depth_.size().pixels() * static_cast<std::uint64_t>(depth_.layers());
}

}  // namespace gnomon::raster
