#include "minimal_program.h"

#include <cmath>

#include "bench_support.h"
#include "raster/passes/izb_pass.h"
#include "raster/passes/light_block.h"
#include "raster/passes/map_shape.h"
#include "raster/passes/moment_pass.h"
#include "raster/passes/shading_pass.h"
#include "raster/renderer.h"
#include "shaders/shared_constants.h"

namespace gnomon::bench {

using raster::Framebuffer;
using raster::Texture2D;

namespace {

GLenum moment_format(raster::Technique technique) {
  return technique == raster::Technique::vsm   ? GL_RG32F
         : technique == raster::Technique::esm ? GL_R32F
                                               : GL_RGBA32F;
}

}  // namespace

/// The passes by hand.
class MinimalProgram::Passes {
 public:
  Passes(const World& world, const raster::RasterOptions& options)
      : world_(world), options_(options), context_(must(raster::create_context(raster::Backend::automatic))) {
    context_->make_current();
    gl_ = must(raster::Gl::load(*context_));
    features_ = raster::scene_features(plan_effects(*world.scene), world);
    programs_ = std::make_unique<raster::ProgramCache>(*gl_, features_);
    view_ = make_view(world.scene->camera, options.size);
    buffers_ =
        std::make_unique<raster::WorldBuffers>(must(raster::WorldBuffers::upload(*gl_, world, features_)));
    buffers_->set_reference(raster::reference_point(world, view_.eye));
    make_map();
    make_moments();
    make_images();
    make_lists();
  }

  void frame() {
    context_->make_current();
    const raster::Gl& gl = *gl_;
    buffers_->bind();
    bind_blocks();
    if (!izb_) {
      draw_map(map_targets_, map_programs_);
      if (middle_) draw_middle();
      (middle_ ? middle_ : depth_).bind(shaders::depth_map_unit);
    }
    if (raster::uses_moments(options_.map.technique)) draw_moments();
    begin(GL_UPPER_LEFT, visibility_target_, options_.size.width, options_.size.height, GL_GREATER);
    const float back = shaders::camera_clear_depth;
    gl->ClearNamedFramebufferfv(visibility_target_.id(), GL_DEPTH, 0, &back);
    gl->ClearNamedFramebufferuiv(visibility_target_.id(), GL_COLOR, 0, &no_id);
    buffers_->draw_triangles(camera_programs_, camera_clip_, raster::WorldBuffers::Drawn::seen);
    if (izb_) draw_lists();
    fullscreen(color_target_, options_.size, *shade_program_);
    gl->Finish();
  }

 private:
  void make_map() {
    const Light& light = world_.scene->lights[0];
    const double aspect = double(options_.size.width) / options_.size.height;
    light_view_ = must(raster::fit_map(world_, light, world_.scene->camera, aspect, options_.map, {}));
    const Vec3& reference = buffers_->reference();
    const auto rounding = raster::bias_rounding(options_.map, light_view_, world_, reference);
    const double bias = raster::constant_bias_world(options_.map.bias, rounding, light_view_, world_);
    light_block_ = raster::Buffer(*gl_);
    light_block_.write_one(
        raster::make_light_block(light, light_view_, options_.map, bias, rounding, reference));
    if (options_.map.technique == raster::Technique::izb) return;
    depth_ = make_depth(map_targets_);
    map_programs_ = must(programs_->triangles({}));
    for (int face = 0; face < light_view_.face_count; ++face)
      map_clips_.push_back(light_clip_from_relative(light_view_, face, buffers_->reference()));
    if (options_.map.technique == raster::Technique::midpoint) make_middle();
  }

  Texture2D make_depth(std::vector<Framebuffer>& targets) {
    Texture2D depth(*gl_, GL_DEPTH_COMPONENT32F, {options_.map.size, options_.map.size},
                    light_view_.face_count);
    for (int face = 0; face < light_view_.face_count; ++face) {
      targets.emplace_back(*gl_).attach(GL_DEPTH_ATTACHMENT, depth, face);
      targets.back().draw_to(0);
    }
    return depth;
  }

  void make_middle() {
    second_ = make_depth(second_targets_);
    peel_programs_ = must(programs_->triangles({.peel = true}));
    peel_programs_.set_peel(0, std::exp2(-23.0f));
    middle_ = Texture2D(*gl_, GL_R32F, {options_.map.size, options_.map.size}, 1);
    middle_target_ = Framebuffer(*gl_);
    middle_target_.attach(GL_COLOR_ATTACHMENT0, middle_, 0);
    middle_target_.draw_to(1);
    middle_program_ = must(raster::Program::link(*gl_, "fullscreen.vert", "midpoint.frag", {}));
  }

  // The lists' buffers are those of the pass, bound by drawing once; the programs and calls are its own.
  void make_lists() {
    if (options_.map.technique != raster::Technique::izb) return;
    const raster::Gl& gl = *gl_;
    izb_ = std::make_unique<raster::IzbPass>(*gl_, *programs_);
    unused_map_ = std::make_unique<raster::DepthMapPass>(*gl_, *programs_);
    const Light& light = world_.scene->lights[0];
    const raster::MapJob job{*buffers_,    light,  light_view_,   *unused_map_,
                             options_.map, &view_, shading_.get()};
    must(shading_->draw_visibility(*buffers_, view_));
    must(izb_->prepare(job));
    must(izb_->draw(job));
    GLint heads = 0;
    gl->GetIntegeri_v(GL_IMAGE_BINDING_NAME, shaders::izb_heads_image, &heads);
    heads_ = static_cast<GLuint>(heads);
    std::vector<std::string_view> defines{"DIRECTIONAL"};
    if (features_.alpha_mask) defines.emplace_back("ALPHA_MASK");
    if (features_.alpha_mask && features_.textures) defines.emplace_back("TEXTURES");
    insert_ = must(raster::Program::link(gl, "fullscreen.vert", "izb/insert.frag", defines));
    block_ = must(raster::Program::link(gl, "izb/triangle.vert", "izb/block.frag", defines));
    gl->ProgramUniform1ui(insert_.id(), shaders::triangle_count_uniform, world_.triangle_count());
    gl->ProgramUniform1i(block_.id(), shaders::face_uniform, 0);
    no_target_ = Framebuffer(gl);
  }

  void make_moments() {
    if (!raster::uses_moments(options_.map.technique)) return;
    const Light& light = world_.scene->lights[0];
    const ImageSize size{options_.map.size, options_.map.size};
    const int levels = raster::moment_max_level(options_.map.filter, light.type, options_.map.size) + 1;
    const GLenum format = moment_format(options_.map.technique);
    moments_ = Texture2D(*gl_, format, size, 1, levels);
    moments_.set_linear_filtering();
    rows_ = Texture2D(*gl_, format, size, 1);
    moment_target_ = Framebuffer(*gl_);
    moment_target_.attach(GL_COLOR_ATTACHMENT0, moments_, 0);
    moment_target_.draw_to(1);
    row_target_ = Framebuffer(*gl_);
    row_target_.attach(GL_COLOR_ATTACHMENT0, rows_, 0);
    row_target_.draw_to(1);
    convert_ =
        must(programs_->fullscreen("moments.frag", raster::moment_shader(options_.map, light, light_view_)));
    blur_ = must(programs_->fullscreen("blur.frag", {}));
  }

  void make_images() {
    const raster::Gl& gl = *gl_;
    // The camera's block and matrix are those of the shading pass; its set-up is not timed.
    shading_ = std::make_unique<raster::ShadingPass>(*gl_, *programs_);
    must(shading_->prepare(options_.size, {0, options_.size.height}, false));
    shading_->set_camera(*buffers_, view_);
    GLint block = 0;
    gl->GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, shaders::camera_block, &block);
    camera_block_ = static_cast<GLuint>(block);
    const Mat4 relative = Mat4(Vec4(1, 0, 0, 0), Vec4(0, 1, 0, 0), Vec4(0, 0, 1, 0),
                               Vec4(buffers_->reference() - view_.eye, 1.0));
    camera_clip_ =
        clip_from_view(view_, raster::depth_reach(world_, view_)) * view_from_eye_relative(view_) * relative;
    visible_ = Texture2D(gl, GL_R32UI, options_.size);
    camera_depth_ = Texture2D(gl, GL_DEPTH_COMPONENT32F, options_.size);
    color_ = Texture2D(gl, GL_RGBA32F, options_.size);
    visibility_target_ = Framebuffer(gl);
    visibility_target_.attach(GL_DEPTH_ATTACHMENT, camera_depth_);
    visibility_target_.attach(GL_COLOR_ATTACHMENT0, visible_);
    visibility_target_.draw_to(1);
    color_target_ = Framebuffer(gl);
    color_target_.attach(GL_COLOR_ATTACHMENT0, color_);
    color_target_.draw_to(1);
    camera_programs_ = must(programs_->triangles({.primitive_ids = true}));
    raster::ShadePermutation permutation;
    permutation.first_light = true;
    permutation.light = world_.scene->lights[0].type;
    permutation.receiver_plane = options_.map.bias.receiver_plane;
    permutation.technique = raster::technique_shader(options_.map, world_.scene->lights[0]);
    for (std::string& define : raster::map_defines(options_.map))
      permutation.technique.defines.push_back(std::move(define));
    shade_program_ = must(programs_->shade(permutation));
  }

  void bind_blocks() const {
    light_block_.bind(GL_UNIFORM_BUFFER, shaders::light_block);
    (*gl_)->BindBufferBase(GL_UNIFORM_BUFFER, shaders::camera_block, camera_block_);
  }

  void begin(GLenum origin, const Framebuffer& target, int width, int height, GLenum depth_test) const {
    const raster::Gl& gl = *gl_;
    gl->BindFramebuffer(GL_FRAMEBUFFER, target.id());
    gl->ClipControl(origin, GL_ZERO_TO_ONE);
    gl->Viewport(0, 0, width, height);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_DEPTH_CLAMP);
    gl->DepthMask(GL_TRUE);
    gl->DepthFunc(depth_test);
  }

  void fullscreen(const Framebuffer& target, ImageSize size, const raster::Program& program) const {
    const raster::Gl& gl = *gl_;
    visible_.bind(shaders::visibility_unit);
    gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    if (moments_) moments_.bind(shaders::moments_unit);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target.id());
    gl->Viewport(0, 0, size.width, size.height);
    gl->Disable(GL_DEPTH_TEST);
    program.use();
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
  }

  void draw_map(const std::vector<Framebuffer>& targets, const raster::TrianglePrograms& programs) const {
    const float far = shaders::map_clear_depth;
    for (std::size_t face = 0; face < targets.size(); ++face) {
      begin(GL_LOWER_LEFT, targets[face], options_.map.size, options_.map.size, GL_LESS);
      (*gl_)->ClearNamedFramebufferfv(targets[face].id(), GL_DEPTH, 0, &far);
      buffers_->draw_triangles(programs, map_clips_[face], raster::WorldBuffers::Drawn::casters);
    }
  }

  void draw_middle() const {
    const raster::Gl& gl = *gl_;
    depth_.bind(shaders::first_layer_unit);
    draw_map(second_targets_, peel_programs_);
    depth_.bind(shaders::depth_map_unit);
    second_.bind(shaders::second_layer_unit);
    gl->Disable(GL_DEPTH_TEST);
    gl->BindFramebuffer(GL_FRAMEBUFFER, middle_target_.id());
    middle_program_.use();
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
  }

  void draw_lists() const {
    const raster::Gl& gl = *gl_;
    gl->BindFramebuffer(GL_FRAMEBUFFER, no_target_.id());
    gl->Disable(GL_DEPTH_TEST);
    const GLuint nothing = 0;
    gl->ClearTexImage(heads_, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &nothing);
    const auto pass = [&](GLenum origin, int width, int height, const raster::Program& program,
                          GLsizei vertices) {
      gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
      gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
      gl->ClipControl(origin, GL_ZERO_TO_ONE);
      gl->Viewport(0, 0, width, height);
      program.use();
      gl->DrawArrays(GL_TRIANGLES, 0, vertices);
      gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    };
    visible_.bind(shaders::visibility_unit);
    pass(GL_UPPER_LEFT, options_.size.width, options_.size.height, insert_, 3);
    pass(GL_LOWER_LEFT, options_.map.size, options_.map.size, block_,
         static_cast<GLsizei>(6 * world_.triangle_count()));
  }

  void draw_moments() const {
    const raster::Gl& gl = *gl_;
    gl->Disable(GL_DEPTH_TEST);
    const auto pass = [&](const Framebuffer& target, const raster::Program& program) {
      gl->BindFramebuffer(GL_FRAMEBUFFER, target.id());
      program.use();
      gl->DrawArrays(GL_TRIANGLES, 0, 3);
    };
    pass(moment_target_, *convert_);
    gl->ProgramUniform1i(blur_->id(), shaders::blur_radius_uniform, options_.map.filter.blur_radius_texels);
    moments_.bind(shaders::moments_unit);
    gl->ProgramUniform2i(blur_->id(), shaders::step_uniform, 1, 0);
    pass(row_target_, *blur_);
    rows_.bind(shaders::moments_unit);
    gl->ProgramUniform2i(blur_->id(), shaders::step_uniform, 0, 1);
    pass(moment_target_, *blur_);
    gl->GenerateTextureMipmap(moments_.id());
  }

  const World& world_;
  raster::RasterOptions options_;
  std::unique_ptr<raster::Context> context_;
  std::unique_ptr<raster::Gl> gl_;
  raster::SceneFeatures features_;
  std::unique_ptr<raster::ProgramCache> programs_;
  std::unique_ptr<raster::WorldBuffers> buffers_;
  std::unique_ptr<raster::ShadingPass> shading_;
  View view_;
  LightView light_view_;
  std::vector<Mat4> map_clips_;
  Mat4 camera_clip_{1.0};
  raster::Buffer light_block_;
  GLuint camera_block_ = 0;
  GLuint heads_ = 0;
  Texture2D depth_, second_, middle_, moments_, rows_, visible_, camera_depth_, color_;
  std::vector<Framebuffer> map_targets_, second_targets_;
  std::unique_ptr<raster::IzbPass> izb_;
  std::unique_ptr<raster::DepthMapPass> unused_map_;
  raster::Program middle_program_, insert_, block_;
  Framebuffer middle_target_, no_target_, moment_target_, row_target_, visibility_target_, color_target_;
  raster::TrianglePrograms map_programs_, camera_programs_, peel_programs_;
  const raster::Program *convert_ = nullptr, *blur_ = nullptr, *shade_program_ = nullptr;
};

MinimalProgram::MinimalProgram(const World& world, const raster::RasterOptions& options)
    : passes_(std::make_unique<Passes>(world, options)) {}
MinimalProgram::~MinimalProgram() = default;

void MinimalProgram::frame() {
  passes_->frame();
}

}  // namespace gnomon::bench
