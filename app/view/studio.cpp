#include "app/view/studio.h"

#include "compare/outputs.h"
#include "scene/exposure.h"
#include "scene/files/image_io.h"
#include "scene/timing.h"

namespace gnomon::app {

namespace {

constexpr int preview_divisor = 4;  // of width and height

ImageSize preview_size(ImageSize full) {
  return {std::max(1, full.width / preview_divisor), std::max(1, full.height / preview_divisor)};
}

Expected<std::unique_ptr<raster::Renderer>> make_window_renderer(std::unique_ptr<raster::Context> context,
                                                                 const LoadedScene& loaded,
                                                                 const std::string& shader_folder) {
  return make_renderer(std::move(context), loaded, shader_folder);
}

}  // namespace

Expected<std::unique_ptr<Studio>> Studio::create(std::unique_ptr<raster::Context> context,
                                                 const LoadedScene& loaded,
                                                 const compare::CompareOptions& options,
                                                 const std::string& shader_folder,
                                                 std::function<void()> on_finished) {
  auto renderer = make_window_renderer(std::move(context), loaded, shader_folder);
  if (!renderer) return fail(renderer.error());
  return std::unique_ptr<Studio>(new Studio(std::move(*renderer), loaded, options, std::move(on_finished)));
}

Studio::Studio(std::unique_ptr<raster::Renderer> renderer, const LoadedScene& loaded,
               const compare::CompareOptions& options, std::function<void()> on_finished)
    : loaded_(loaded),
      options_(options),
      renderer_(std::move(renderer)),
      exposure_(loaded.scene->exposure),
      worker_(*loaded.scene, *loaded.world, loaded.plan, options, std::move(on_finished)) {}

Expected<raster::RasterFrame> Studio::render(const Setup& setup, ImageSize size, bool analysis, int runs) {
  raster::RasterOptions options = options_.raster;
  options.size = size;
  options.map = setup.map;
  options.runs = runs;
  options.analysis = analysis;
  const std::vector<std::uint32_t> lights{setup.light};
  return renderer_->render(options, lights);
}

Expected<void> Studio::draw(ViewState& state) {
  if (drawn_revision_ == state.revision) return {};
  place(state.given, state.setup, *loaded_.scene);
  const Stopwatch watch;
  auto frame = render(state.setup, state.setup.size, false, 0);
  if (!frame) return fail(frame.error());
  live_ms_ = watch.elapsed_ms();
  live_ = std::move(*frame);
  drawn_revision_ = state.revision;
  const raster::LightRecord& record = live_.lights.front();
  state.texel_world = texel_world_ = raster::texel_world(record.map.view, *loaded_.world);
  state.max_map_size = renderer_->info().max_map_size;
  if (!exposure_) exposure_ = auto_exposure(live_.color);
  encode_live();
  return {};
}

/// The picture as `compare` would write it, with the factor that the newest comparison chose.
void Studio::encode_live() {
  live_picture_ = display_image(live_.color, *exposure_);
}

Expected<void> Studio::compare(const ViewState& state) {
  const Expected<void> taken = take_outcome();
  const Expected<void> started = start_next(state);
  return taken ? started : taken;
}

Expected<void> Studio::take_outcome() {
  std::optional<Expected<ComparisonOutcome>> taken = worker_.take();
  if (!taken) return {};
  if (!*taken) return fail(taken->error());
  outcome_ = std::move(**taken);
  if (exposure_ == outcome_->comparison.exposure) return {};
  exposure_ = outcome_->comparison.exposure;
  encode_live();
  return {};
}

Expected<void> Studio::start_next(const ViewState& state) {
  const bool same = started_revision_ == state.revision;
  if (same && started_full_) return {};
  if (worker_.busy()) {
    if (!same) worker_.give_up();
    return {};
  }
  const ImageSize small = preview_size(state.setup.size);
  const bool preview = !same && !(small == state.setup.size);
  started_revision_ = state.revision;
  started_full_ = !preview;
  auto drawn = render(state.setup, preview ? small : state.setup.size, true, preview ? 0 : 1);
  if (!drawn) return fail(drawn.error());
  worker_.start({state.revision, preview, loaded_.scene->camera, loaded_.scene->lights, std::move(*drawn)});
  return {};
}

bool Studio::is_done(const ViewState& state) const {
  return outcome_ && !outcome_->preview && outcome_->revision == state.revision &&
         drawn_revision_ == state.revision;
}

const Rgb8Image& Studio::picture(Picture picture) const {
  if (!outcome_) return live_picture_;
  switch (picture) {
    case Picture::raytrace:
      return outcome_->raytrace;
    case Picture::difference:
      return outcome_->difference;
    case Picture::labels:
      return outcome_->labels;
    case Picture::depth:
      return outcome_->depth;
    case Picture::raster:
      break;
  }
  return live_picture_;
}

Readings Studio::readings(const ViewState& state) const {
  Readings out{live_.lights.front().bias_constant_world, texel_world_, live_ms_, {}};
  if (!outcome_) return out;
  const raster::LightRecord& drawn = outcome_->comparison.raster.lights.front();
  out.compared = Readings::Compared{outcome_->revision == state.revision,
                                    outcome_->preview,
                                    outcome_->comparison.lights.front().error.wrong_fraction,
                                    drawn.map_pass.median(),
                                    drawn.shade_pass.median(),
                                    outcome_->comparison.raytraced.lights.front().exact_times().median(),
                                    outcome_->comparison.lights.front().error.mean_absolute};
  return out;
}

}  // namespace gnomon::app
