#include "lab/view/work/studio.h"

#include <algorithm>

#include "compare/result/layout.h"
#include "compare/result/outputs.h"
#include "raster/technique_traits.h"
#include "scene/base/interruptible.h"
#include "scene/base/timing.h"
#include "scene/exposure.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::lab {

namespace {

constexpr int preview_divisor = 4;  // of width and height

ImageSize preview_size(ImageSize full) {
  return {std::max(1, full.width / preview_divisor), std::max(1, full.height / preview_divisor)};
}

}  // namespace

Expected<std::unique_ptr<Studio>> Studio::create(std::unique_ptr<raster::Context> context,
                                                 std::shared_ptr<const app::LoadedScene> loaded,
                                                 const compare::CompareOptions& options,
                                                 const std::string& shader_folder,
                                                 std::function<void()> on_finished,
                                                 std::function<bool()> overtaken) {
  auto renderer = app::make_renderer(std::move(context), *loaded, shader_folder);
  if (!renderer) return fail(renderer.error());
  return std::unique_ptr<Studio>(new Studio(std::move(*renderer), std::move(loaded), options,
                                            std::move(on_finished), std::move(overtaken)));
}

Studio::Studio(std::unique_ptr<raster::Renderer> renderer, std::shared_ptr<const app::LoadedScene> loaded,
               const compare::CompareOptions& options, std::function<void()> on_finished,
               std::function<bool()> overtaken)
    : loaded_(std::move(loaded)),
      options_(options),
      given_(given_scene(*loaded_->scene, *loaded_->world, loaded_->paths)),
      renderer_(std::move(renderer)),
      overtaken_(std::move(overtaken)),
      exposure_(loaded_->scene->exposure),
      worker_(*loaded_->scene, *loaded_->world, options, std::move(on_finished)) {}

/// Of a picture alone.
raster::RasterOptions Studio::raster_options(const Setup& setup, ImageSize size) const {
  raster::RasterOptions options = options_.raster;
  options.size = size;
  options.map = setup.map;
  options.runs = 0;
  options.analysis = false;
  return options;
}

Expected<raster::RasterFrame> Studio::render(const Setup& setup, const raster::RasterOptions& options) {
  const std::vector<std::uint32_t> lights{setup.light};
  std::optional<raster::MapCamera> frozen;
  if (setup.map_camera) frozen = raster::MapCamera{.camera = *setup.map_camera};
  raster::set_map_camera(*renderer_, frozen);
  const Interruptible drawing(overtaken_);
  return renderer_->render(options, lights);
}

Expected<void> Studio::draw(const DrawOrder& order) {
  if (live_.revision == order.revision) return {};
  place(given_, order.setup, *loaded_->scene);
  const Stopwatch watch;
  raster::RasterOptions options = raster_options(order.setup, order.setup.size);
  options.keep_time = !worker_.busy();
  auto frame = render(order.setup, options);
  if (!frame) return fail(frame.error());
  const raster::LightRecord& record = frame->lights.front();
  live_.raster_ms = watch.elapsed_ms();
  live_.revision = order.revision;
  live_.camera = loaded_->scene->camera;
  live_.light = loaded_->scene->lights[order.setup.light];
  live_.map = record.map.view;
  live_.map_camera.reset();
  if (const auto& frozen = order.setup.map_camera)
    live_.map_camera = compare::camera_corners(*loaded_->world, *frozen, order.setup.size);
  live_.bias_world = record.bias_constant_world;
  live_.texel_world = raster::texel_world(record.map.view, *loaded_->world);
  live_color_ = std::move(frame->color);
  if (!exposure_) exposure_ = auto_exposure(live_color_);
  encode_live();
  return {};
}

/// A light's size is what can call for another effect than the scene's own.
EffectPlan Studio::plan_of(const Setup& setup) const {
  const bool resized =
      std::any_of(setup.lights.begin(), setup.lights.end(),
                  [](const std::optional<app::LightPose>& pose) { return pose && pose->size; });
  return resized ? plan_effects(*loaded_->scene) : loaded_->plan;
}

/// The picture as `compare` would write it, with the factor that the newest comparison chose.
void Studio::encode_live() {
  live_.picture = std::make_shared<const Rgb8Image>(display_image(live_color_, *exposure_));
}

Expected<void> Studio::compare(const DrawOrder& order) {
  const Expected<void> taken = receive_outcome();
  const Expected<void> started = start_next(order);
  if (!taken) return taken;
  return started ? time_shadows(order) : started;
}

/// One run.
Expected<void> Studio::time_in_software(const DrawOrder& order) {
  raster::RasterOptions options = raster_options(order.setup, order.setup.size);
  options.runs = 1, options.shadow_cost = true;
  const auto drawn = render(order.setup, options);
  if (!drawn) return fail(drawn.error());
  shadow_timer_.take_run(order.revision, drawn->lights.front());
  return {};
}

/// While nothing else is to be done.
Expected<void> Studio::time_shadows(const DrawOrder& order) {
  if (worker_.busy() || shadow_timer_.knows(order.revision)) return {};
  if (!outcome_ || outcome_->preview || outcome_->revision != order.revision) return {};
  if (raster::draws_in_software(renderer_->info().renderer)) return time_in_software(order);
  if (raster::is_external(order.setup.map.technique)) return {};
  return shadow_timer_.take_turn(order.revision, *renderer_, [&](int drawings) -> Expected<void> {
    raster::RasterOptions options = raster_options(order.setup, order.setup.size);
    options.span_drawings = drawings;
    const auto drawn = render(order.setup, options);
    return drawn ? Expected<void>{} : fail(drawn.error());
  });
}

Expected<void> Studio::receive_outcome() {
  std::optional<Expected<ComparisonOutcome>> taken = worker_.take();
  if (!taken) return {};
  if (!*taken) {
    known_rays_.reset();
    return fail(taken->error());
  }
  if (!(*taken)->preview && (*taken)->revision == started_revision_) known_rays_ = started_rays_;
  outcome_ = std::make_shared<const ComparisonOutcome>(std::move(**taken));
  if (exposure_ == outcome_->comparison.exposure) return {};
  exposure_ = outcome_->comparison.exposure;
  encode_live();
  return {};
}

Expected<void> Studio::start_next(const DrawOrder& order) {
  const bool same = started_revision_ == order.revision;
  if (same && started_full_) return {};
  if (worker_.busy()) {
    if (!same) worker_.give_up();
    return {};
  }
  const ImageSize small = preview_size(order.setup.size);
  started_rays_ = {loaded_->scene->camera, loaded_->scene->lights, order.setup.light, order.setup.precision,
                   order.setup.size};
  const bool known = known_rays_ == started_rays_;
  const bool preview = !same && !known && !(small == order.setup.size);
  if (!preview && !known) known_rays_.reset();  // the worker keeps one frame
  raster::RasterOptions options = raster_options(order.setup, preview ? small : order.setup.size);
  options.analysis = true;
  options.runs = preview ? 0 : 1;
  auto drawn = render(order.setup, options);
  if (!drawn) return fail(drawn.error());
  started_revision_ = order.revision;
  started_full_ = !preview;
  worker_.start({order.revision, preview, preview || known, order.setup.precision, plan_of(order.setup),
                 loaded_->scene->camera, loaded_->scene->lights, std::move(*drawn)});
  return {};
}

}  // namespace gnomon::lab
