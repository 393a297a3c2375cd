// The order of things: fit a light's map, draw it (timed), keep it (with primitive ids), shade with it
// (timed), keep the picture and the records; light after light. All OpenGL state is set where it is used and
// given back at the end.
#include "raster/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <new>

#include "raster/custom_shader.h"
#include "raster/depth_map_pass.h"
#include "raster/external_pass.h"
#include "raster/light_block.h"
#include "raster/map_shape.h"
#include "raster/options_check.h"
#include "raster/shader_folder.h"
#include "raster/shading_pass.h"
#include "raster/technique_pass.h"
#include "raster/technique_traits.h"
#include "scene/stages.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

// Exact techniques draw a depth map for the records alone.
bool hands_on_map(const RasterOptions& options) {
  return options.analysis && (options.map_contents || !compares_depths(options.map.technique));
}

class GlRenderer final : public Renderer {
 public:
  GlRenderer(std::unique_ptr<Context> context, std::unique_ptr<Gl> gl, const World& world,
             const SceneFeatures& features, WorldBuffers buffers)
      : context_(std::move(context)),
        gl_(std::move(gl)),
        world_(&world),
        programs_(*gl_, features),
        buffers_(std::move(buffers)),
        map_pass_(*gl_, programs_),
        shading_(*gl_, programs_),
        light_block_(*gl_),
        external_(*gl_) {
    info_ = {context_->backend(), gl_->text(GL_VERSION), gl_->text(GL_RENDERER), max_map_size(*gl_)};
  }
  GlRenderer(const GlRenderer&) = delete;
  GlRenderer& operator=(const GlRenderer&) = delete;
  ~GlRenderer() override { context_->make_current(); }  // the members below are destroyed next, context last

  Expected<void> compile();
  Expected<RasterFrame> render(const RasterOptions& options, std::span<const std::uint32_t> lights) override;
  const ContextInfo& info() const override { return info_; }
  void use_external_visibility(std::shared_ptr<ExternalVisibility> visibility) override {
    external_.use(std::move(visibility));
  }

 private:
  struct Job;  // one call of render()
  Expected<RasterFrame> render_checked(const RasterOptions& options, std::span<const std::uint32_t> lights);
  Expected<void> draw_light(Job& job, std::uint32_t light, LightRecord* record);
  Expected<void> prepare_maps(Job& job, const MapJob& map, bool with_ids);
  Expected<void> draw_map(const MapJob& map, bool with_ids);
  Expected<LightView> fit(Job& job, const Light& light, const MapOptions& map);
  Expected<void> time_and_draw_map(Job& job, const MapJob& map, LightRecord* record);
  Expected<void> prepare_external(Job& job, const VisibilityRequest& request, LightRecord* record);
  Expected<void> see(const Job& job, const VisibilityRequest* request);
  Expected<void> shade(Job& job, const MapJob& map_job, const VisibilityRequest& request,
                       LightRecord* record);
  Expected<void> shade_without_light(Job& job);
  using Pass = std::function<Expected<void>()>;
  /// `repeats`: the stage that all of it is charged to, for only frames that are kept count as made.
  Expected<void> time_pass(std::string_view repeats, int runs, Times& times, const Pass& warm_up,
                           const Pass& pass);
  /// The map of the last frame with records, as long as the device holds it.
  struct KeptMap {
    RasterOptions options;  ///< without the bias
    Light light;
    ShadowMap map;
    Times map_pass;
  };
  bool take_kept_map(const Job& job, const Light& light, LightRecord& record) const;
  void keep_map(const Job& job, const Light& light, const LightRecord& record);
  void restore_state() const;

  std::unique_ptr<Context> context_;
  std::unique_ptr<Gl> gl_;
  const World* world_;
  ContextInfo info_;
  ProgramCache programs_;
  WorldBuffers buffers_;
  DepthMapPass map_pass_;
  ShadingPass shading_;
  Buffer light_block_;
  std::unique_ptr<TechniquePass> technique_pass_;
  Technique technique_ = Technique::hard;  ///< of technique_pass_
  ExternalPass external_;
  std::optional<KeptMap> kept_map_;
  std::optional<ShadePermutation> last_timed_;  ///< of the shading pass
};

struct GlRenderer::Job {
  RasterOptions options;
  View view;
  RasterFrame frame{};
  bool visibility_drawn = false;
  bool first_light = true;
};

ShadePermutation shade_permutation(const Light& light, const MapOptions& map, bool first, bool records) {
  ShadePermutation p;
  p.first_light = first;
  p.records = records;
  p.light = light.type;
  p.slope_bias = map.bias.slope != 0.0;
  p.normal_offset = map.bias.normal_offset_texels > 0.0;
  p.receiver_plane = map.bias.receiver_plane;
  p.technique = technique_shader(map, light);
  for (std::string& define : map_defines(map)) p.technique.defines.push_back(std::move(define));
  return p;
}

std::uint64_t texels_of(const LightView& view) {
  const auto side = static_cast<std::uint64_t>(view.size);
  return static_cast<std::uint64_t>(view.face_count) * side * side;
}

// The permutations of the default options; others are linked when they are first asked for, as all are where
// files of the user's could be at fault that the frame does not need.
Expected<void> GlRenderer::compile() {
  if (!gl_->shader_folder().replaced().empty()) return {};
  for (const bool ids : {false, true}) {
    if (auto program = programs_.triangles(ids, false); !program) return fail(program.error());
    if (!programs_.features().alpha_mask) continue;
    if (auto program = programs_.triangles(ids, true); !program) return fail(program.error());
  }
  bool first = true;
  for (const Light& light : world_->scene->lights) {
    if (auto program = programs_.shade(shade_permutation(light, MapOptions{}, first, true)); !program)
      return fail(program.error());
    first = false;
  }
  return gl_->check("compiling the shaders");
}

Expected<RasterFrame> GlRenderer::render(const RasterOptions& options,
                                         std::span<const std::uint32_t> lights) {
  if (!context_->make_current())
    return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  Expected<RasterFrame> frame;
  try {
    frame = render_checked(options, lights);
  } catch (const std::bad_alloc&) {
    frame = fail(ErrorKind::graphics, "out of memory for the images and depth maps to read back");
  }
  restore_state();
  return frame;
}

Expected<RasterFrame> GlRenderer::render_checked(const RasterOptions& options,
                                                 std::span<const std::uint32_t> lights) {
  const Scene& scene = *world_->scene;
  if (auto ok = check_options(options, info_); !ok) return fail(ok.error());
  for (const std::uint32_t light : lights) {
    if (light >= scene.lights.size())
      return fail(ErrorKind::usage,
                  fmt::format("no such light (got {}, the scene has {})", light, scene.lights.size()));
  }
  gl_->shader_folder().begin_frame();
  Job job{options, make_view(scene.camera, options.size)};
  job.options.map = effective_options(options.map);
  job.frame.context = info_;
  job.frame.options = job.options;
  job.frame.lights.resize(lights.size());
  if (auto ok = shading_.prepare(options.size, options.analysis && !lights.empty()); !ok)
    return fail(ok.error());
  buffers_.set_reference(reference_point(*world_, job.view.eye));
  shading_.set_camera(buffers_, job.view);
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    const auto found = std::find(lights.begin(), lights.end(), light);
    LightRecord* record =
        found == lights.end() ? nullptr : &job.frame.lights[static_cast<std::size_t>(found - lights.begin())];
    if (auto ok = draw_light(job, light, record); !ok) return fail(ok.error());
  }
  if (scene.lights.empty()) {
    if (auto ok = shade_without_light(job); !ok) return fail(ok.error());
  }
  const TimedStage reading("read-back");
  shading_.read_color(job.frame.color);
  shading_.read_primitives(job.frame.primitive);
  if (auto ok = gl_->check("reading the picture back"); !ok) return fail(ok.error());
  job.frame.replaced_shaders = gl_->shader_folder().used();
  return std::move(job.frame);
}

// The warm-up, then the timed runs, each from an idle device to an idle device.
Expected<void> GlRenderer::time_pass(std::string_view repeats, int runs, Times& times, const Pass& warm_up,
                                     const Pass& pass) {
  if (runs == 0) return {};
  const TimedStage stage(repeats, TimedStage::Inner::included);
  if (auto ok = warm_up(); !ok) return ok;
  (*gl_)->Finish();
  Expected<void> result;
  for (int i = 0; i < runs && result; ++i) {
    time_run(times, [&] {
      result = pass();
      (*gl_)->Finish();
    });
  }
  return result;
}

// Everything that a map and its time hang on, where the camera is no part of that and one light has the maps
// for itself. Only frames with whole records are kept, so that who asks for times alone gets new ones.
std::optional<RasterOptions> map_key(const RasterOptions& options, std::size_t lights) {
  const Technique technique = options.map.technique;
  if (follows_camera(technique) || !compares_depths(technique)) return std::nullopt;
  if (lights != 1 || !options.analysis || !options.map_contents) return std::nullopt;
  RasterOptions key = options;
  key.map.bias = {};
  return key;
}

bool GlRenderer::take_kept_map(const Job& job, const Light& light, LightRecord& record) const {
  const auto key = map_key(job.options, world_->scene->lights.size());
  if (!key || !kept_map_ || kept_map_->options != *key || kept_map_->light != light) return false;
  record.map = kept_map_->map;
  record.map_pass = kept_map_->map_pass;
  return true;
}

void GlRenderer::keep_map(const Job& job, const Light& light, const LightRecord& record) {
  // A frame whose map was kept would not tell which of the user's shaders drew it.
  if (!gl_->shader_folder().replaced().empty()) return;
  if (auto key = map_key(job.options, world_->scene->lights.size()))
    kept_map_ = KeptMap{*key, light, record.map, record.map_pass};
}

Expected<void> GlRenderer::draw_light(Job& job, std::uint32_t index, LightRecord* record) {
  const Light& light = world_->scene->lights[index];
  MapOptions map = job.options.map;
  if (record != nullptr) {
    if (auto ok = check_light(map.technique, light); !ok) return ok;
  } else if (!has_map_for(map.technique, light.type)) {
    map.technique = Technique::hard;  // lights the picture, and is not compared
  }
  const auto view = fit(job, light, map);
  if (!view) return fail(view.error());
  const BiasRounding rounding = bias_rounding(map, *view, *world_, buffers_.reference());
  const double constant = constant_bias_world(map.bias, rounding, *view, *world_);
  light_block_.write_one(make_light_block(light, *view, map, constant, rounding, buffers_.reference()));
  light_block_.bind(GL_UNIFORM_BUFFER, shaders::light_block);
  if (record != nullptr) {
    record->light = index;
    record->bias_constant_world = constant;
    record->rounding = rounding;
    record->texel_world = texel_world(*view, *world_);
    record->rounding_world = rounding_world(rounding, *view, *world_);
    record->map.view = *view;
    record->map.format = map.depth_format;
    if (!job.frame.custom_shader) job.frame.custom_shader = custom_shader(gl_->shader_folder(), map, light);
  }
  const MapJob map_job{buffers_, light, *view, map_pass_, map, &job.view, &shading_};
  const VisibilityRequest request{
      index, *view, job.view, job.options.shadow_samples, job.options.seed, job.options.analysis};
  const bool with_ids = record != nullptr && hands_on_map(job.options);
  if (map.technique == Technique::hybrid) {
    kept_map_.reset();
    if (auto ok = prepare_external(job, request, record); !ok) return ok;
    if (!with_ids) return shade(job, map_job, request, record);
  }
  if (auto ok = prepare_maps(job, map_job, with_ids); !ok) return ok;
  if (record == nullptr || !take_kept_map(job, light, *record)) {
    kept_map_.reset();
    if (auto ok = time_and_draw_map(job, map_job, record); !ok) return ok;
    if (record != nullptr) keep_map(job, light, *record);
  }
  return shade(job, map_job, request, record);
}

// The comparison's rungs below V6 are those of a depth map, which is drawn for them alone.
Expected<void> GlRenderer::prepare_external(Job& job, const VisibilityRequest& request, LightRecord* record) {
  if (auto ok = external_.check(); !ok) return ok;
  job.frame.map_texels += texels_of(request.map);
  if (record != nullptr) {
    const Pass pass = [&] { return external_.prepare(request, true); };
    if (auto ok = time_pass("sheet runs", job.options.runs, record->map_pass, pass, pass); !ok) return ok;
  }
  const TimedStage stage("sheets");
  return external_.prepare(request, false);
}

// The surfaces that the camera sees are read back where the technique fits its map to them.
Expected<LightView> GlRenderer::fit(Job& job, const Light& light, const MapOptions& map) {
  std::vector<Vec3> visible;
  if (fits_to_samples(map)) {
    if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return fail(ok.error());
    job.visibility_drawn = true;
    visible = shading_.read_positions(*world_, job.view);
  }
  return fit_map(*world_, light, double(job.options.size.width) / job.options.size.height, map, visible);
}

Expected<void> GlRenderer::prepare_maps(Job& job, const MapJob& map, bool with_ids) {
  if (technique_ != map.options.technique) {
    technique_pass_ = make_technique_pass(*gl_, programs_, map.options.technique);
    technique_ = map.options.technique;
  }
  if (auto ok = map_pass_.prepare(map.view, map.options.depth_format, with_ids); !ok) return ok;
  if (map.options.technique == Technique::hybrid) return {};  // drawn for the records alone
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (!replaced) job.frame.map_texels += texels_of(map.view);
  std::uint64_t bytes = replaced ? 0 : map_pass_.bytes();
  if (technique_pass_ != nullptr) {
    if (auto ok = technique_pass_->prepare(map); !ok) return ok;
    job.frame.map_texels += technique_pass_->texels();
    bytes += technique_pass_->bytes();
  }
  job.frame.map_bytes = std::max(job.frame.map_bytes, bytes);
  return {};
}

Expected<void> GlRenderer::draw_map(const MapJob& map, bool with_ids) {
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (!replaced || with_ids) {
    if (auto ok = map_pass_.draw(buffers_, map.view, map.options.cull, with_ids); !ok) return ok;
  }
  return technique_pass_ != nullptr ? technique_pass_->draw(map) : Expected<void>{};
}

Expected<void> GlRenderer::time_and_draw_map(Job& job, const MapJob& map, LightRecord* record) {
  if (technique_pass_ != nullptr && technique_pass_->replaces_map() && !job.visibility_drawn) {
    if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
    job.visibility_drawn = true;
  }
  if (record != nullptr && map.options.technique != Technique::hybrid) {
    const Pass pass = [&]() -> Expected<void> {
      if (fits_to_samples(map.options)) {
        if (auto fitted = fit(job, map.light, map.options); !fitted) return fail(fitted.error());
      }
      return draw_map(map, false);
    };
    if (auto ok = time_pass("map runs", job.options.runs, record->map_pass, pass, pass); !ok) return ok;
  }
  const bool with_ids = record != nullptr && hands_on_map(job.options);
  TimedStage drawing(with_ids ? "map with ids" : "map");
  if (auto ok = draw_map(map, with_ids); !ok) return ok;
  (*gl_)->Finish();
  drawing.end();
  const TimedStage reading("read-back");
  if (with_ids) map_pass_.read(record->map, true);
  if (with_ids && technique_pass_ != nullptr) technique_pass_->read(record->map);
  return gl_->check("drawing the shadow map");
}

/// What the camera sees and, with a request, how much of the light that gets.
Expected<void> GlRenderer::see(const Job& job, const VisibilityRequest* request) {
  if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
  if (request == nullptr) return {};
  if (auto ok = external_.find(*request, shading_); !ok) return ok;
  external_.bind_for_lookup();
  return {};
}

Expected<void> GlRenderer::shade(Job& job, const MapJob& map_job, const VisibilityRequest& request,
                                 LightRecord* record) {
  const Light& light = map_job.light;
  const MapOptions& map = map_job.options;
  const VisibilityRequest* asked = map.technique == Technique::hybrid ? &request : nullptr;
  const bool records = record != nullptr && job.options.analysis;
  if (asked == nullptr || records) map_pass_.bind_for_lookup();
  if (technique_pass_ != nullptr) technique_pass_->bind_for_lookup();
  if (record != nullptr) {
    const ShadePermutation timed = shade_permutation(light, map, job.first_light, false);
    const Pass pass = [&]() -> Expected<void> {
      if (auto seen = see(job, asked); !seen) return seen;
      job.visibility_drawn = true;
      return shading_.draw_light(buffers_, timed, !job.first_light);
    };
    const Pass warm_up = [&]() -> Expected<void> {
      if (last_timed_ == timed) return {};
      if (asked != nullptr) return pass();
      return shading_.warm_up(buffers_, job.view, timed, !job.first_light);
    };
    if (auto ok = time_pass("shading runs", job.options.runs, record->shade_pass, warm_up, pass); !ok)
      return ok;
    if (job.options.runs > 0) last_timed_ = timed;
  }
  if (!job.visibility_drawn || (asked != nullptr && (record == nullptr || job.options.runs == 0))) {
    if (auto ok = see(job, asked); !ok) return ok;
    job.visibility_drawn = true;
  }
  const ShadePermutation kept = shade_permutation(light, map, job.first_light, records);
  TimedStage shading(records ? "shading with records" : "shading");
  if (auto ok = shading_.draw_light(buffers_, kept, false); !ok) return ok;
  (*gl_)->Finish();
  shading.end();
  const TimedStage reading("read-back");
  if (records) shading_.read_records(*record);
  if (records && !gl_->shader_folder().replaced().empty()) {
    const std::string file = technique_file(map, light);
    if (auto ok = check_visibility(record->visibility, gl_->shader_folder(), file); !ok) return ok;
  }
  if (asked != nullptr && record != nullptr) {
    record->external = external_.costs(request, records);
    job.frame.map_bytes = std::max(job.frame.map_bytes, record->external->bytes);
  }
  job.first_light = false;
  return gl_->check("shading");
}

Expected<void> GlRenderer::shade_without_light(Job& job) {
  if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
  ShadePermutation permutation;
  permutation.no_light = true;
  permutation.first_light = true;
  if (auto ok = shading_.draw_light(buffers_, permutation, false); !ok) return ok;
  return gl_->check("shading");
}

// A window's context has other users.
void GlRenderer::restore_state() const {
  const Gl& gl = *gl_;
  gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl->BindVertexArray(0);
  gl->UseProgram(0);
  gl->ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  gl->Disable(GL_DEPTH_TEST);
  gl->Disable(GL_DEPTH_CLAMP);
  gl->Disable(GL_CULL_FACE);
  gl->Disable(GL_BLEND);
  gl->DepthFunc(GL_LESS);
}

}  // namespace

Expected<std::unique_ptr<Renderer>> Renderer::create(std::unique_ptr<Context> context, const World& world,
                                                     const EffectPlan& plan,
                                                     const std::string& shader_folder) {
  if (!context->make_current()) return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  auto gl = Gl::load(*context);
  if (!gl) return fail(gl.error());
  auto folder = ShaderFolder::read(shader_folder);
  if (!folder) return fail(folder.error());
  (*gl)->shader_folder() = std::move(*folder);
  const SceneFeatures features = scene_features(plan, world);
  TimedStage uploading("upload");
  auto buffers = WorldBuffers::upload(**gl, world, features);
  uploading.end();
  if (!buffers) return fail(buffers.error());
  auto renderer =
      std::make_unique<GlRenderer>(std::move(context), std::move(*gl), world, features, std::move(*buffers));
  if (auto ok = renderer->compile(); !ok) return fail(ok.error());
  return renderer;
}

}  // namespace gnomon::raster
