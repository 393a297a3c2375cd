#include "raster/passes/shading_pass.h"

#include <fmt/core.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "raster/bands.h"
#include "raster/gl/fill.h"
#include "raster/passes/impostors.h"
#include "raster/programs/shader_folder.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

Mat4 clip_from_relative(const View& drawn, const World& world, const Vec3& reference) {
  const Mat4 relative_to_eye = glm::translate(Mat4(1.0), reference - drawn.eye);
  return clip_from_view(drawn, depth_reach(world, drawn)) * view_from_eye_relative(drawn) * relative_to_eye;
}

LightFace axes(const Vec3& right, const Vec3& up, const Vec3& forward) {
  LightFace frame;
  frame.right = right, frame.up = up, frame.forward = forward;
  return frame;
}

CameraBlock camera_block(const View& drawn, const World& world, const Vec3& reference) {
  CameraBlock block{};
  block.clip_from_relative = Mat4f(clip_from_relative(drawn, world, reference));
  block.eye_and_reach = Vec4f(Vec4(drawn.eye - reference, depth_reach(world, drawn)));
  block.right_and_tan_x = Vec4f(Vec4(drawn.right, drawn.tan_half_x));
  block.up_and_tan_y = Vec4f(Vec4(drawn.up, drawn.tan_half_y));
  block.forward = Vec4f(Vec4(drawn.forward, 0.0));
  block.size = Vec4f(drawn.size.width, drawn.size.height, 0.0f, 0.0f);
  block.half_extent = Vec4f(drawn.half_x, drawn.half_y, 0.0f, 0.0f);
  block.counts = glm::uvec4(world.triangle_count(), 0, 0, 0);
  block.ambient = Vec4f(world.scene->ambient, 0.0f);
  block.background = Vec4f(world.scene->background, 0.0f);
  return block;
}

}  // namespace

ShadingPass::ShadingPass(Gl& gl, ProgramCache& programs)
    : gl_(&gl), programs_(&programs), camera_block_(gl) {}

Expected<void> ShadingPass::prepare(ImageSize size, const PictureRows& rows, bool with_records) {
  if (!(size_ == size)) {
    *this = ShadingPass(*gl_, *programs_);
    if (auto ok = prepare_seen(size); !ok) return ok;
    size_ = size;
  }
  const ImageSize shaded{size.width, rows.count};
  if (!(color_ && color_.size() == shaded && (!with_records || record_)))
    if (auto ok = prepare_shaded(shaded, with_records); !ok) return ok;
  rows_ = rows;
  return {};
}

Expected<void> ShadingPass::prepare_seen(ImageSize size) {
  Gl& gl = *gl_;
  visibility_ = Texture2D(gl, GL_R32UI, size);
  depth_ = Texture2D(gl, GL_DEPTH_COMPONENT32F, size);
  visibility_target_ = Framebuffer(gl);
  visibility_target_.attach(GL_DEPTH_ATTACHMENT, depth_);
  visibility_target_.attach(GL_COLOR_ATTACHMENT0 + shaders::primitive_output, visibility_);
  const bool solids = programs_->features().solids();
  if (solids) {
    solid_distance_ = Texture2D(gl, GL_R32F, size);
    visibility_target_.attach(GL_COLOR_ATTACHMENT0 + shaders::solid_distance_output, solid_distance_);
  }
  visibility_target_.draw_to(solids ? 2 : 1);
  if (auto ok = gl.check("making the buffers of what is seen"); !ok) return ok;
  return visibility_target_.check_complete();
}

Expected<void> ShadingPass::prepare_shaded(ImageSize size, bool with_records) {
  Gl& gl = *gl_;
  for (Texture2D* old : {&trial_color_, &record_, &flags_, &drawn_visibility_}) *old = Texture2D();
  color_ = Texture2D(gl, GL_RGBA32F, size);
  color_target_ = Framebuffer(gl);
  color_target_.attach(GL_COLOR_ATTACHMENT0, color_);
  color_target_.draw_to(1);
  color_target_.clear_color();
  if (with_records) {
    record_ = Texture2D(gl, GL_RGBA32F, size);
    flags_ = Texture2D(gl, GL_R8UI, size);
    drawn_visibility_ = Texture2D(gl, GL_RG32F, size);
    record_target_ = record_target(color_);
  }
  if (auto ok = gl.check("making the image buffers"); !ok) return ok;
  if (auto ok = color_target_.check_complete(); !ok) return ok;
  return with_records ? record_target_.check_complete() : Expected<void>{};
}

Framebuffer ShadingPass::record_target(const Texture2D& radiance) const {
  Framebuffer target(*gl_);
  target.attach(GL_COLOR_ATTACHMENT0 + shaders::radiance_output, radiance);
  target.attach(GL_COLOR_ATTACHMENT0 + shaders::record_output, record_);
  target.attach(GL_COLOR_ATTACHMENT0 + shaders::flags_output, flags_);
  target.attach(GL_COLOR_ATTACHMENT0 + shaders::visibility_output, drawn_visibility_);
  target.draw_to(4);
  return target;
}

Expected<void> ShadingPass::prepare_trial() {
  if (trial_color_) return {};
  trial_color_ = Texture2D(*gl_, GL_RGBA32F, size());
  trial_target_ = Framebuffer(*gl_);
  trial_target_.attach(GL_COLOR_ATTACHMENT0, trial_color_);
  trial_target_.draw_to(1);
  trial_target_.clear_color();
  if (record_) trial_record_target_ = record_target(trial_color_);
  return gl_->check("making the timing image");
}

void ShadingPass::set_camera(const WorldBuffers& world, const View& view) {
  CameraBlock block = camera_block(drawn_view(world.world(), view), world.world(), world.reference());
  block.size.z = static_cast<float>(rows_.first);
  camera_block_.write_one(block);
  camera_block_.bind(GL_UNIFORM_BUFFER, shaders::camera_block);
}

Expected<void> ShadingPass::draw_visibility(const WorldBuffers& world, const View& view) {
  const Gl& gl = *gl_;
  const auto programs = programs_->triangles({.primitive_ids = true});
  if (!programs) return fail(programs.error());
  seen_.reset();
  world.bind();
  camera_block_.bind(GL_UNIFORM_BUFFER, shaders::camera_block);
  gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);  // row 0 of every image is the top
  const ImageSize drawn = world.drawn_part(size_);
  gl->Viewport(0, 0, drawn.width, drawn.height);
  gl->Disable(GL_BLEND);
  gl->Disable(GL_SCISSOR_TEST);
  gl->Disable(GL_CULL_FACE);
  gl->Enable(GL_DEPTH_TEST);
  // What lies behind a pinhole is cut away whatever its depth; what lies behind an orthographic eye, by its depth alone.
  const View drawn_by = drawn_view(world.world(), view);
  view.orthographic() ? gl->Disable(GL_DEPTH_CLAMP) : gl->Enable(GL_DEPTH_CLAMP);
  gl->DepthMask(GL_TRUE);
  gl->DepthFunc(GL_GREATER);
  gl->BindFramebuffer(GL_FRAMEBUFFER, visibility_target_.id());
  const float clear_depth = shaders::camera_clear_depth;
  gl->ClearNamedFramebufferfv(visibility_target_.id(), GL_DEPTH, 0, &clear_depth);
  gl->ClearNamedFramebufferuiv(visibility_target_.id(), GL_COLOR, 0, &no_id);
  world.draw_triangles(*programs, clip_from_relative(drawn_by, world.world(), world.reference()),
                       WorldBuffers::Drawn::seen);
  if (auto shapes = draw_shapes(world, drawn_by); !shapes) return shapes;
  if (!world.draws_little()) seen_ = seen_by(world, view);
  return {};
}

ShadingPass::Seen ShadingPass::seen_by(const WorldBuffers& world, const View& view) {
  return {view.eye,     view.right,        view.up,
          view.forward, world.reference(), {view.tan_half_x, view.tan_half_y, view.half_x, view.half_y}};
}

bool ShadingPass::shows(const WorldBuffers& world, const View& view) const {
  return seen_ == seen_by(world, view);
}

Times& ShadingPass::times(const WorldBuffers& world, const View& view) {
  const Seen seen = seen_by(world, view);
  if (timed_ != seen) timed_ = seen, times_ = {};
  return times_;
}

Expected<void> ShadingPass::draw_shapes(const WorldBuffers& buffers, const View& drawn) {
  const bool parallel = drawn.orthographic();
  const Projection projection{
      drawn.eye, axes(drawn.right, drawn.up, drawn.forward),
      parallel ? Vec2(drawn.half_x, drawn.half_y) : Vec2(drawn.tan_half_x, drawn.tan_half_y), !parallel,
      Vec2(2.0 / size_.width, 2.0 / size_.height)};
  const LightFace world_axes = axes(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1));
  return draw_impostors(*gl_, *programs_, buffers.world(), projection, world_axes,
                        {.camera = true, .perspective = true});
}

Expected<void> ShadingPass::draw_light(const WorldBuffers& world, const ShadePermutation& permutation,
                                       bool trial) {
  return draw_light(world, permutation, trial, all_rows());
}

Expected<void> ShadingPass::draw_light(const WorldBuffers& world, const ShadePermutation& permutation,
                                       bool trial, const PictureRows& rows) {
  const Gl& gl = *gl_;
  const auto program = programs_->shade(permutation);
  if (!program) return fail(program.error());
  if (trial) {
    if (auto ok = prepare_trial(); !ok) return ok;
  }
  world.bind();
  camera_block_.bind(GL_UNIFORM_BUFFER, shaders::camera_block);
  bind_visibility();
  const Framebuffer& target = permutation.records ? (trial ? trial_record_target_ : record_target_)
                                                  : (trial ? trial_target_ : color_target_);
  gl->BindFramebuffer(GL_FRAMEBUFFER, target.id());
  gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  const ImageSize drawn = world.drawn_part(size());
  gl->Viewport(0, 0, drawn.width, drawn.height);
  gl->Disable(GL_DEPTH_TEST);
  gl->Disable(GL_CULL_FACE);
  gl->Disable(GL_SCISSOR_TEST);
  gl->Disable(GL_BLEND);
  const bool draws_nothing = world.draws_little() && !trial && !permutation.first_light;
  if (draws_nothing) {  // what others added to the picture stays
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(0, 0, 0, 0);
  }
  if (!permutation.first_light) {
    gl->Enablei(GL_BLEND, shaders::radiance_output);  // lights add up
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFunc(GL_ONE, GL_ONE);
  }
  if (permutation.records) {
    const Vec4f unwritten(unwritten_visibility);
    gl->ClearNamedFramebufferfv(target.id(), GL_COLOR, shaders::visibility_output, &unwritten.x);
  }
  (*program)->use();
  draws_nothing ? gl->DrawArrays(GL_TRIANGLES, 0, 3) : fill(gl, drawn, rows);
  return {};
}

void ShadingPass::bind_visibility() const {
  visibility_.bind(shaders::visibility_unit);
  if (solid_distance_) solid_distance_.bind(shaders::solid_distance_unit);
}

void ShadingPass::read_color(ColorImage& out) const {
  out = Image<Vec3f>(size());
  color_.read(GL_RGB, GL_FLOAT, std::as_writable_bytes(std::span(out.data)));
}

std::vector<Vec3> ShadingPass::read_positions(const World& world, const View& view) const {
  Image<float> depth(size_);
  depth_.read(GL_DEPTH_COMPONENT, GL_FLOAT, std::as_writable_bytes(std::span(depth.data)));
  const View drawn = drawn_view(world, view);
  const double reach = depth_reach(world, drawn);
  std::vector<Vec3> positions;
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const double stored = depth.at(x, y);
      if (!(stored > 0.0)) continue;
      const Ray ray = pixel_ray(drawn, x + 0.5, y + 0.5);
      const double along = drawn.orthographic() ? reach * (1.0 - stored) : reach / stored;
      positions.push_back(ray.at(along / glm::dot(ray.direction, drawn.forward)));
    }
  }
  return positions;
}

void ShadingPass::read_primitives(Image<std::uint32_t>& out) const {
  out = Image<std::uint32_t>(size());
  visibility_.read_rows(rows_, GL_RED_INTEGER, GL_UNSIGNED_INT, std::as_writable_bytes(std::span(out.data)));
}

void ShadingPass::read_drawn_visibility(Image<float>& out) const {
  out = Image<float>(size());
  drawn_visibility_.read(GL_RED, GL_FLOAT, std::as_writable_bytes(std::span(out.data)));
}

void ShadingPass::read_records(LightRecord& record) const {
  const ImageSize size = this->size();
  std::vector<Vec4f> values(size.pixels());
  std::vector<std::uint8_t> flags(size.pixels());
  record_.read(GL_RGBA, GL_FLOAT, std::as_writable_bytes(std::span(values)));
  flags_.read(GL_RED_INTEGER, GL_UNSIGNED_BYTE, std::as_writable_bytes(std::span(flags)));
  read_drawn_visibility(record.visibility);
  std::vector<float> lookups(size.pixels());
  drawn_visibility_.read(GL_GREEN, GL_FLOAT, std::as_writable_bytes(std::span(lookups)));
  record.lookups = Image<std::uint16_t>(size);
  record.texel_uv = Image<Vec2f>(size);
  record.face = Image<std::uint8_t>(size);
  record.distance = Image<float>(size);
  record.gap = Image<float>(size);
  record.outside_map = Image<std::uint8_t>(size);
  parallel_for(values.size(), [&](std::size_t i) {
    record.texel_uv.data[i] = Vec2f(values[i]);
    record.distance.data[i] = values[i].z;
    // A slope without bound leaves no number: nothing is above the bias then.
    record.gap.data[i] = std::isnan(values[i].w) ? -std::numeric_limits<float>::infinity() : values[i].w;
    record.lookups.data[i] = static_cast<std::uint16_t>(lookups[i]);
    record.face.data[i] = static_cast<std::uint8_t>(flags[i] >> shaders::flag_face_shift);
    record.outside_map.data[i] = (flags[i] & shaders::flag_outside_map) != 0 ? 1 : 0;
  });
}

Expected<void> ExternalPass::check(Technique technique) const {
  if (asked_.contains(technique)) return {};
  return fail(ErrorKind::internal, fmt::format("the technique {} has nothing to ask for its visibility",
                                               technique_name(technique)));
}

Expected<void> ExternalPass::find(const VisibilityRequest& request, const ShadingPass& shading) {
  shading.read_primitives(primitive_);
  ExternalVisibility& asked = *asked_.at(request.options.technique);
  if (auto* rows = dynamic_cast<ExternalRows*>(&asked)) rows->set_first_row(shading.rows().first);
  if (!(image_.size == primitive_.size)) {
    image_ = Image<float>(primitive_.size);
    texture_ = Texture2D(*gl_, GL_R32F, primitive_.size);
  }
  if (auto ok = asked.find(request, primitive_, image_); !ok) return ok;
  texture_.write(GL_RED, GL_FLOAT, std::as_bytes(std::span(image_.data)));
  return gl_->check("uploading the visibility");
}

void ExternalPass::bind_for_lookup() const {
  texture_.bind(shaders::external_visibility_unit);
}

}  // namespace gnomon::raster
