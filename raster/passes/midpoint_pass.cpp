#include "raster/passes/midpoint_pass.h"

#include "raster/gl/fill.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

constexpr std::string_view midpoint_stages[] = {"midpoint.frag"};

}  // namespace

extern const TechniqueDrawing midpoint_drawing{
    .make_pass = [](Gl& gl, ProgramCache& programs) -> std::unique_ptr<TechniquePass> {
      return std::make_unique<MidpointPass>(gl, programs);
    },
    .stages = midpoint_stages};

Expected<void> MidpointPass::prepare(const MapJob& job) {
  const LightView& view = job.view;
  if (auto ok = second_.prepare(view, job.options.depth_format); !ok) return ok;
  const ImageSize size{view.size, view.size};
  if (middle_ && middle_.size() == size && middle_.layers() == view.face_count) return {};
  faces_.clear();
  middle_ = Texture2D();
  middle_ = Texture2D(*gl_, GL_R32F, size, view.face_count);
  if (auto ok = gl_->check("a midpoint map"); !ok) return ok;
  std::vector<Framebuffer> faces;
  for (int i = 0; i < view.face_count; ++i) {
    Framebuffer& face = faces.emplace_back(*gl_);
    face.attach(GL_COLOR_ATTACHMENT0, middle_, i);
    face.draw_to(1);
    if (auto ok = face.check_complete(); !ok) return ok;
    face.clear_color();
  }
  faces_ = std::move(faces);
  return {};
}

Expected<const Program*> MidpointPass::program(const LightView& view) {
  const bool perspective = view.projection == LightProjection::perspective;
  const auto key = std::pair(perspective, view.reversed);
  if (const auto found = programs_.find(key); found != programs_.end()) return &found->second;
  std::vector<std::string_view> defines;
  if (perspective) defines.emplace_back("PERSPECTIVE");
  if (view.reversed) defines.emplace_back("REVERSED");
  auto made = Program::link(*gl_, "fullscreen.vert", "midpoint.frag", defines);
  if (!made) return fail(made.error());
  return &programs_.emplace(key, std::move(*made)).first->second;
}

Expected<void> MidpointPass::draw(const MapJob& job) {
  const Gl& gl = *gl_;
  if (auto ok = second_.draw(job.world, job.view, job.options.cull, {}, &job.map); !ok) return ok;
  const auto program_of_view = program(job.view);
  if (!program_of_view) return fail(program_of_view.error());
  (*program_of_view)->use();
  job.map.bind(shaders::depth_map_unit);
  second_.bind(shaders::second_layer_unit);
  gl->Disable(GL_DEPTH_TEST);
  gl->Disable(GL_CULL_FACE);
  const ImageSize drawn = job.world.drawn_part(middle_.size());
  gl->Viewport(0, 0, drawn.width, drawn.height);
  for (int face = 0; face < job.view.face_count; ++face) {
    gl->BindFramebuffer(GL_FRAMEBUFFER, faces_[static_cast<std::size_t>(face)].id());
    gl->ProgramUniform1i((*program_of_view)->id(), shaders::face_uniform, face);
    fill(gl, drawn);
  }
  return {};
}

void MidpointPass::bind_for_lookup() const {
  middle_.bind(shaders::depth_map_unit);
}

void MidpointPass::read(ShadowMap& map) const {
  middle_.read(GL_RED, GL_FLOAT, std::as_writable_bytes(std::span(map.depth)));
}

std::uint64_t MidpointPass::texels() const {
  return 2 * middle_.size().pixels() * static_cast<std::uint64_t>(middle_.layers());
}

std::uint64_t MidpointPass::bytes() const {
  return second_.bytes() + 4 * middle_.size().pixels() * static_cast<std::uint64_t>(middle_.layers());
}

}  // namespace gnomon::raster
