// The order of things: fit a light's map, draw it (timed), keep it, shade with it
// (timed), keep the picture and the records; light after light. All OpenGL state is set where it is used and
// given back at the end.
#include "raster/renderer.h"

#include <fmt/core.h>

#include <algorithm>
#include <new>

#include "raster/gl_renderer.h"
#include "raster/passes/light_block.h"
#include "raster/passes/map_shape.h"
#include "raster/programs/shader_folder.h"
#include "raster/technique_traits.h"
#include "raster/use_shaders.h"
#include "scene/base/interruptible.h"
#include "scene/base/stages.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {

// The permutations of the default options; others are linked when they are first asked for, as all are where
// files of the user's could be at fault that the frame does not need.
Expected<void> GlRenderer::compile() {
  if (!gl_->shader_folder().replaced().empty()) return {};
  for (const bool ids : {false, true})
    if (auto programs = programs_.triangles({.primitive_ids = ids}); !programs) return fail(programs.error());
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
  const TimedStage stage("drawing");
  if (!context_->make_current())
    return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  Expected<RasterFrame> frame;
  try {
    frame = render_checked(options, lights);
  } catch (const std::bad_alloc&) {
    frame = fail(ErrorKind::graphics, "out of memory for the images and depth maps to read back");
  } catch (const Interrupted& interrupted) {
    frame = fail(ErrorKind::internal, interrupted.what());
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
  job.rows = rows_.value_or(PictureRows{0, options.size.height});
  job.goes_on = job.visibility_drawn = job.rows.first > 0;
  if (!job.goes_on) fitted_.clear();
  job.options.map = effective_options(options.map);
  job.frame.context = info_;
  job.frame.upload_ms = upload_ms_;
  job.frame.options = job.options;
  job.frame.lights.resize(lights.size());
  if (auto ok = shading_.prepare(options.size, job.rows, options.analysis && !lights.empty()); !ok)
    return fail(ok.error());
  buffers_.set_reference(reference_point(*world_, job.view.eye));
  shading_.set_camera(buffers_, job.view);
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    leave_if_interrupted();
    const auto found = std::find(lights.begin(), lights.end(), light);
    if (options.times_alone && found == lights.end()) {
      job.first_light = false;
      continue;
    }
    LightRecord* record =
        found == lights.end() ? nullptr : &job.frame.lights[static_cast<std::size_t>(found - lights.begin())];
    const std::uint64_t texels_before = job.frame.map_texels;
    if (auto ok = draw_light(job, light, record); !ok) return fail(ok.error());
    if (record != nullptr) record->map_texels = job.frame.map_texels - texels_before;
  }
  if (scene.lights.empty()) {
    if (auto ok = shade_without_light(job); !ok) return fail(ok.error());
  }
  if (!options.times_alone) {
    const ReadBack reading(job.frame);
    shading_.read_color(job.frame.color);
    shading_.read_primitives(job.frame.primitive);
  }
  if (auto ok = gl_->check("reading the picture back"); !ok) return fail(ok.error());
  job.frame.replaced_shaders = gl_->shader_folder().used();
  return std::move(job.frame);
}

namespace {

/// What the map is drawn by: of the bias that of casters, and nothing of how depths are looked up where the map is of depths
/// alone.
MapOptions drawn_by(MapOptions map) {
  const TechniqueTraits& traits = traits_of(map.technique);
  const bool depths_alone = traits.drawing->make_pass == nullptr && !is_external(map.technique);
  if (depths_alone) map.filter = {};
  if (depths_alone && traits.drawing->fit == nullptr) map.technique = Technique::hard;
  const Bias drawn = map.bias;
  map.bias = {};
  map.bias.caster_constant = drawn.caster_constant, map.bias.caster_unit = drawn.caster_unit;
  map.bias.caster_slope = drawn.caster_slope;
  return map;
}

// What follows the camera seldom serves the next frame: its depths are not copied for that.
bool keeps_depths(const RasterOptions& options) {
  return hands_on_map(options) && !follows_camera(options.map.technique);
}

// Who asks for times alone gets new ones.
bool may_take_map(const RasterOptions& options, const RasterOptions& kept) {
  const bool for_times = !options.analysis && options.runs > 0;
  return !for_times && (hands_on_map(kept) || !hands_on_map(options));
}

// Where one light has the maps for itself.
bool outlasts_frame(Technique technique, std::size_t lights) {
  return lights == 1 && compares_depths(technique);
}

// Two large maps are more than a device may have room for.
constexpr double most_texels_beside = 4096.0 * 4096.0;

}  // namespace

bool GlRenderer::holds(const MapSlot& slot, const Job& job, const Light& light, const LightView& view) const {
  if (!slot.kept) return false;
  const KeptMap& kept = *slot.kept;
  const MapOptions& map = job.options.map;
  if (kept.options.map != drawn_by(map) || kept.light != light) return false;
  if (kept.reference != buffers_.reference()) return false;  // its depths were rounded from another point
  if (!same_window(kept.map.view, view)) return false;       // fitted to another camera
  // What a technique makes of its map is there of the last one alone.
  return traits_of(map.technique).drawing->make_pass == nullptr ||
         (&slot == slot_ && technique_ == map.technique);
}

void GlRenderer::choose_slot(const Job& job, const Light& light, const LightView& view) {
  for (MapSlot& slot : slots_)
    if (holds(slot, job, light, view)) {
      slot_ = &slot;
      return;
    }
  const bool small = static_cast<double>(texels_of(view)) <= most_texels_beside;
  if (slot_->kept && small && static_cast<double>(texels_of(slot_->kept->map.view)) <= most_texels_beside)
    slot_ = slot_ == slots_.data() ? &slots_[1] : slots_.data();
  slot_->kept.reset();
}

bool GlRenderer::begin_with_kept_run(const Job& job, const Light& light, LightRecord& record) const {
  const RasterOptions& options = job.options;
  if (!options.times_alone || !holds(*slot_, job, light, record.map.view)) return false;
  if (!slot_->kept->drawn_ms) return false;
  record.map_pass.runs = {*slot_->kept->drawn_ms};
  return !times_again(record.map_pass, options.runs, options.enough_ms);
}

bool GlRenderer::reuse_kept_map(const Job& job, const Light& light, LightRecord& record) const {
  const RasterOptions& options = job.options;
  if (!holds(*slot_, job, light, record.map.view) || !may_take_map(options, slot_->kept->options))
    return false;
  const KeptMap& kept = *slot_->kept;
  const bool same_times = kept.options.runs == options.runs && kept.options.enough_ms == options.enough_ms;
  if (options.runs > 0 && !same_times) return false;
  if (!options.analysis) return true;
  if (hands_on_map(options)) record.map = kept.map;
  if (options.runs == 0) return true;
  record.map_pass = kept.map_pass;
  record.first_map_ms = kept.first_map_ms;
  return true;
}

void GlRenderer::keep_map(const Job& job, const Light& light, const LightRecord& record) {
  // A frame whose map was kept would not tell which of the user's shaders drew it.
  if (!gl_->shader_folder().replaced().empty() || !job.options.analysis) return;
  if (!outlasts_frame(job.options.map.technique, world_->scene->lights.size())) return;
  KeptMap kept{job.options,         light,           buffers_.reference(), {}, record.map_pass,
               record.first_map_ms, job.map_drawn_ms};
  kept.options.map = drawn_by(job.options.map);
  kept.options.map_contents = keeps_depths(job.options);
  if (keeps_depths(job.options))
    kept.map = record.map;
  else
    kept.map.view = record.map.view;
  slot_->kept = std::move(kept);
}

namespace {

CasterBias caster_bias(const MapOptions& map, const LightView& view, const World& world) {
  const bool scales = follows_camera(map.technique) && map.bias.caster_unit == BiasUnit::texel;
  return {caster_bias_world(map.bias, view, world), map.bias.caster_slope,
          scales ? texel_world(view, world) : 0.0};
}

}  // namespace

Expected<void> GlRenderer::draw_light(Job& job, std::uint32_t index, LightRecord* record) {
  const Light& light = world_->scene->lights[index];
  job.light_index = index;
  MapOptions map = job.options.map;
  if (record != nullptr) {
    if (auto ok = check_light(map.technique, light); !ok) return ok;
  } else {  // lights the picture, and is not compared
    map.window = {};
    if (!has_map_for(map.technique, light.type)) map.technique = Technique::hard;
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
    record->caster_constant_world = caster_bias_world(map.bias, *view, *world_);
    record->rounding = rounding;
    record->texel_world = texel_world(*view, *world_);
    record->rounding_world = rounding_world(rounding, *view, *world_);
    record->map.view = *view;
    record->map.format = map.depth_format;
    if (!job.frame.custom_shader) job.frame.custom_shader = custom_shader(gl_->shader_folder(), map, light);
  }
  choose_slot(job, light, *view);
  const MapJob map_job{buffers_, light,     *view,     slot_->pass,
                       map,      &job.view, &shading_, caster_bias(map, *view, *world_)};
  const VisibilityRequest request{index,
                                  *view,
                                  job.view,
                                  map,
                                  job.options.shadow_samples,
                                  job.options.seed,
                                  job.options.film_frame,
                                  job.options.analysis};
  if (is_external(map.technique)) {
    slot_->kept.reset();
    if (auto ok = prepare_external(job, request, record); !ok) return ok;
    if (record == nullptr || !hands_on_map(job.options)) return shade(job, map_job, request, record);
  }
  job.map_started = Stopwatch();
  if (auto ok = prepare_maps(job, map_job); !ok) return ok;
  job.map_drawn_ms.reset();
  const bool drawn =
      record != nullptr && (reuse_kept_map(job, light, *record) || begin_with_kept_run(job, light, *record));
  if (!drawn) {
    slot_->kept.reset();
    if (auto ok = time_and_draw_map(job, map_job, record); !ok) return ok;
    if (record != nullptr) keep_map(job, light, *record);
  }
  if (has_spans(job, record)) {
    spans_.restart();
    if (auto ok = span(job, [&] { return draw_map(map_job, false); }); !ok) return ok;
  }
  return shade(job, map_job, request, record);
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
  gl->FrontFace(GL_CCW);
}

void set_map_camera(Renderer& renderer, const std::optional<MapCamera>& camera) {
  static_cast<GlRenderer&>(renderer).fit_maps_to(camera);  // the one kind that Renderer::create makes
}

Expected<void> GlRenderer::use_shaders(const std::string& path) {
  if (!context_->make_current())
    return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  auto folder = ShaderFolder::read(path);
  if (!folder) return fail(folder.error());
  static_cast<void>(gl_->check("the shaders before"));  // what the driver said of those is no fault of these
  std::set<std::string> others;
  for (const ShaderFolder* of : {&gl_->shader_folder(), &*folder})
    for (const ReplacedShader& file : of->replaced()) others.insert(file.name);
  gl_->shader_folder() = std::move(*folder);
  programs_.forget(others);
  technique_pass_.reset();  // which has programs of its own
  technique_ = Technique::hard;
  for (MapSlot& slot : slots_) slot.kept.reset();
  kept_time_.reset();
  warm_camera_ = false, warm_shadings_.clear(), warm_maps_.clear();
  return {};
}

Expected<void> use_shaders(Renderer& renderer, const std::string& folder) {
  return static_cast<GlRenderer&>(renderer).use_shaders(folder);  // the one kind that Renderer::create makes
}

Expected<std::unique_ptr<Renderer>> Renderer::create(std::unique_ptr<Context> context, const World& world,
                                                     const EffectPlan& plan,
                                                     const std::string& shader_folder) {
  if (!context->make_current()) return fail(ErrorKind::graphics, "the OpenGL context cannot be made current");
  if (world.keeps_instances() && !is_whole(context->backend()))
    return fail(
        ErrorKind::graphics,
        "kept instances are moved in double precision, which WebGL 2 lacks (allowed: --instances flatten)");
  auto gl = Gl::load(*context);
  if (!gl) return fail(gl.error());
  auto folder = ShaderFolder::read(shader_folder);
  if (!folder) return fail(folder.error());
  (*gl)->shader_folder() = std::move(*folder);
  const SceneFeatures features = scene_features(plan, world);
  TimedStage uploading("upload");
  const Stopwatch upload;
  auto buffers = WorldBuffers::upload(**gl, world, features);
  uploading.end();
  const double upload_ms = upload.elapsed_ms();
  if (!buffers) return fail(buffers.error());
  auto renderer = std::make_unique<GlRenderer>(std::move(context), std::move(*gl), world, features,
                                               std::move(*buffers), upload_ms);
  if (auto ok = renderer->compile(); !ok) return fail(ok.error());
  return renderer;
}

}  // namespace gnomon::raster
