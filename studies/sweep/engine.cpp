#include "studies/sweep/engine.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compare/result/figures.h"
#include "compare/result/places.h"
#include "compare/result/views.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "studies/shimmer/shimmer.h"
#include "studies/sweep/engine_impl.h"

namespace gnomon::studies {
namespace {

using compare::Figure;
using compare::LadderInput;
using compare::LightFigures;
using compare::Setting;

// What the truth depends on.
bool same_truth(const Setting& a, const Setting& b) {
  return a.accel == b.accel && a.precision == b.precision && a.raytrace == b.raytrace &&
         a.camera == b.camera && a.lights == b.lights && a.compared == b.compared;
}

// The drawing options are equal but for the constant bias.
bool same_but_bias(const raster::RasterOptions& a, const raster::RasterOptions& b) {
  raster::RasterOptions rebiased = a;
  rebiased.map.bias.constant = b.map.bias.constant;
  rebiased.map.bias.unit = b.map.bias.unit;
  return rebiased == b && raster::scales_bias(a.map) == raster::scales_bias(b.map);
}

// Of one light's compared pixels, times `scale`.
void add_gaps(const LadderInput& in, double scale, compare::GapLists& gaps) {
  const Image<compare::Label> labels = compare::sort_pixels(in);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (!compare::is_compared(labels.data[i])) continue;
    const auto truth = compare::true_visibility(in, i);
    if (truth == 0.5f)
      ++gaps.ties;
    else
      (truth > 0.5f ? gaps.lit : gaps.shadowed)
          .push_back(static_cast<float>(scale * in.record().gap.data[i]));
  }
}

/// Whether `other` shows, and takes, what was drawn for `drawn`, but for its constant bias. A shader of the user's need not
/// compare with the bias at all.
bool derives_from(const Setting& drawn, const Setting& other, const raster::RasterFrame& frame) {
  return frame.replaced_shaders.empty() && compare::biases_follow_from_gaps(other.raster.map) &&
         same_but_bias(drawn.raster, other.raster);
}

double raster_ms(const raster::RasterFrame& frame) {
  double sum = 0.0;
  for (const raster::LightRecord& light : frame.lights)
    sum += light.map_pass.median() + light.shade_pass.median();
  return sum;
}

}  // namespace

LadderInput Engine::Impl::input(const raster::RasterFrame& frame, std::size_t i) const {
  return {*tracer, topology, frame, comparison.raytraced, i};
}

void Engine::Impl::trace(const Setting& setting) {
  scene.camera = setting.camera;  // another view's may stand there
  scene.lights = setting.lights;
  if (truth_of && same_truth(*truth_of, setting)) return;
  lower.clear();
  table.clear();
  backdrop = {};
  drawn_for.reset();
  if (!tracer || kept.accel != setting.accel || tracer->precision() != setting.precision) {
    tracer = std::make_unique<raytrace::Tracer>(world, setting.accel, setting.precision);
    kept.accel = setting.accel;
  }
  comparison.plan = plan_effects(scene);
  comparison.raytraced =
      raytrace::trace_frame(*tracer, comparison.plan, scene.camera, setting.compared, setting.raytrace);
  truth_of = setting;
  ++work.truths;
}

Expected<void> Engine::Impl::draw(const Setting& setting) {
  drawn_for.reset();
  auto frame = renderer.render(compare::drawing_options(setting.raster, setting.raytrace), setting.compared);
  if (!frame) return fail(frame.error());
  comparison.raster = std::move(*frame);
  drawn_for = setting;
  ++work.renders;
  return {};
}

void Engine::Impl::derive(const Setting& setting, Detail detail) {
  comparison.raster.options = setting.raster;
  comparison.raster.options.map = raster::effective_options(setting.raster.map);
  for (raster::LightRecord& record : comparison.raster.lights) {
    const double world_units =
        raster::constant_bias_world(setting.raster.map.bias, record.rounding, record.map.view, world);
    record.bias_constant_world = world_units;
    if (detail == Detail::images) compare::rebias(comparison.raster.primitive, world_units, record);
  }
  ++work.derived;
}

void Engine::Impl::climb_lower() {
  const TimedStage stage("labels");
  const raster::RasterFrame& frame = comparison.raster;
  bool same = lower.size() == frame.lights.size();
  for (std::size_t i = 0; same && i < lower.size(); ++i)
    same = compare::have_same_lower_climb(*lower_frame, frame, i);
  if (same) return;
  lower.clear();
  map_measures.clear();
  lower_frame = std::make_unique<raster::RasterFrame>(frame);
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const LadderInput in = input(*lower_frame, i);
    lower.push_back(std::make_unique<compare::LowerClimb>(in, compare::sort_pixels(in)));
    ++work.lower_climbs;
  }
}

std::size_t Engine::Impl::expected_place(const raster::Bias& bias) const {
  const auto same = [&](const raster::Bias& b) { return b.constant == bias.constant && b.unit == bias.unit; };
  return static_cast<std::size_t>(std::find_if(expected.begin(), expected.end(), same) - expected.begin());
}

bool Engine::Impl::fill_table() {
  if (!table.empty()) return true;
  if (perceptual || comparison.lights.size() != lower.size()) return false;
  for (const auto& light : lower)
    if (!biases_add_up(*light)) return false;
  right_codes = {};
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const LadderInput in = input(comparison.raster, i);
    std::vector<double> biases;
    for (const raster::Bias& bias : expected)
      biases.push_back(raster::constant_bias_world(bias, in.record().rounding, in.record().map.view, world));
    table.push_back(compare_biases(*lower[i], in, comparison.lights[i], biases,
                                   compare::MeasureOptions{}.bias_curve_points));
  }
  return true;
}

bool Engine::Impl::measure_from_table(const raster::Bias& bias) {
  const TimedStage stage("biases");
  const std::size_t place = expected_place(bias);
  if (place == expected.size() || !fill_table()) return false;
  for (std::size_t i = 0; i < table.size(); ++i) comparison.lights[i] = table[i].lights[place];
  table_place = place;
  return true;
}

Expected<void> Engine::Impl::measure() {
  if (!derived) climb_lower();
  has_images = true;
  const compare::Plan plan{.tracer = *tracer,
                           .picture = comparison.raster.primitive.size,
                           .lights = truth_of->compared,
                           .measure = {.perceptual = perceptual, .by_cascade = false},
                           .maps = map_measures,
                           .topology = &topology,
                           .places = kept.places ? &*kept.places : nullptr};
  const auto measured = compare::measure_frames(
      comparison, plan, [&](const LadderInput& in) { return compare::climb_up(*lower[in.index], in); });
  if (!measured) return measured;
  map_measures.assign(comparison.lights.begin(), comparison.lights.end());
  return {};
}

Expected<void> Engine::Impl::compare(const Setting& setting, Detail detail) {
  trace(setting);
  derived = drawn_for && derives_from(*drawn_for, setting, comparison.raster);
  if (!derived) {
    if (auto drawn = draw(setting); !drawn) return drawn;
    table.clear();
    return measure();
  }
  if (detail == Detail::numbers && expected_place(setting.raster.map.bias) < expected.size()) {
    derive(setting, Detail::numbers);
    has_images = false;
    if (measure_from_table(setting.raster.map.bias)) return {};
    --work.derived;
  }
  derive(setting, Detail::images);
  return measure();
}

// Draws for what is not a comparison: nothing of what stood before holds for it.
Expected<void> Engine::Impl::draw_alone(const Setting& setting) {
  auto drawn = draw(setting);
  table.clear();
  lower.clear();
  drawn_for.reset();
  return drawn;
}

Expected<double> Engine::Impl::time_drawing(const Setting& setting) {
  Setting bare = setting;
  bare.raster.analysis = false;
  if (auto drawn = draw_alone(bare); !drawn) return fail(drawn.error());
  return raster_ms(comparison.raster);
}

Expected<void> Engine::Impl::time_again(const Setting& setting) {
  if (timed_for && same_truth(*timed_for, setting) && derives_from(*timed_for, setting, comparison.raster))
    return {};
  scene.camera = setting.camera, scene.lights = setting.lights;
  timed_for.reset();
  Setting bare = setting;
  bare.raster.analysis = false;
  if (auto drawn = draw_alone(bare); !drawn) return drawn;
  timed_for = setting;
  return {};
}

std::vector<LightFigures> Engine::Impl::figures(const Figure& measure) const {
  std::vector<LightFigures> out;
  for (std::size_t i = 0; i < comparison.raster.lights.size(); ++i)
    out.push_back(compare::measure_ends(input(comparison.raster, i), {&measure}));
  return out;
}

void Engine::Impl::add_gaps_of(Probe& probe, double texel_world, bool scales) const {
  const raster::RasterFrame& frame = comparison.raster;
  for (std::size_t i = 0; i < frame.lights.size(); ++i)
    add_gaps(input(frame, i), scales ? texel_world / frame.lights[i].texel_world : 1.0, probe.gaps);
}

void Engine::Impl::add_figures_at(const raster::Bias& bias, const Figure& measure, Probe& probe) {
  raster::RasterFrame& frame = comparison.raster;
  for (raster::LightRecord& record : frame.lights)
    compare::rebias(frame.primitive,
                    raster::constant_bias_world(bias, record.rounding, record.map.view, world), record);
  for (LightFigures& light : figures(measure)) probe.lights_at_best.push_back(std::move(light));
}

Expected<Probe> Engine::Impl::probe(const Setting& setting, const Figure& measure) {
  trace(setting);
  Setting without_map = setting;
  without_map.raster.map_contents = false;
  if (auto drawn = draw_alone(without_map); !drawn) return fail(drawn.error());
  Probe probe;
  const raster::RasterFrame& frame = comparison.raster;
  for (const raster::LightRecord& light : frame.lights)
    if (light.external) probe.rays += light.external->rays;
  probe.lights = figures(measure);
  if (film && measure.needs == compare::FigureNeeds::film) {
    const auto flips = count_flips(setting);
    if (!flips) return fail(flips.error());
    for (std::size_t i = 0; i < flips->size(); ++i) probe.lights[i].shimmer = (*flips)[i];
  }
  for (const LightFigures& light : probe.lights) probe.compared += light.pixels.compared;
  probe.raster_ms = raster_ms(frame);
  probe.map_texels = frame.map_texels;
  probe.map_bytes = frame.map_bytes;
  if (!frame.lights.empty()) {
    probe.bias_world = frame.lights.front().bias_constant_world;
    probe.texel_world = raster::texel_world(frame.lights.front().map.view, world);
  }
  probe.custom_shader = frame.custom_shader.has_value();
  probe.reads_bias = !frame.custom_shader || frame.custom_shader->reads_bias;
  return probe;
}

Engine::Engine(Scene& scene, const World& world, raster::Renderer& renderer, bool perceptual)
    : kept_(new Kept{scene, world, renderer, perceptual, raytrace::Topology(world)}) {
  impls_.push_back(std::make_unique<Impl>(*kept_));
}

Engine::~Engine() = default;

void Engine::look_from(std::vector<compare::JudgedView> views, const Figure& measure) {
  views_ = std::move(views), measure_ = &measure, shown_ = 0;
  while (impls_.size() < views_.size()) impls_.push_back(std::make_unique<Impl>(*kept_));
  impls_.resize(std::max<std::size_t>(views_.size(), 1));
}

Setting Engine::posed(const Setting& setting, std::size_t view) const {
  if (views_.empty()) return setting;
  Setting out = setting;
  compare::Pose pose = views_[view].pose({setting.camera, setting.lights});
  out.camera = pose.camera, out.lights = std::move(pose.lights);
  return out;
}

namespace {

void add_probe(Probe&& of_view, Probe& sum) {
  sum.compared += of_view.compared, sum.raster_ms += of_view.raster_ms, sum.rays += of_view.rays;
  for (LightFigures& light : of_view.lights) sum.lights.push_back(std::move(light));
}

}  // namespace

// The bias that the gaps of all views say is best is asked for once for all lights. Where the constant scales it is a
// number of texels, and each light has its own.
Expected<Probe> Engine::probe(const Setting& setting, const Figure& measure) {
  Probe all;
  const bool scales = raster::scales_bias(setting.raster.map);
  bool from_gaps = measure.needs != compare::FigureNeeds::film;
  for (std::size_t view = 0; view < impls_.size(); ++view) {
    auto probe = impls_[view]->probe(posed(setting, view), measure);
    if (!probe) return probe;
    from_gaps = from_gaps && compare::biases_follow_from_gaps(impls_[view]->comparison.raster);
    if (view == 0)
      all = std::move(*probe);
    else
      add_probe(std::move(*probe), all);
    if (from_gaps) impls_[view]->add_gaps_of(all, all.texel_world, scales);
  }
  all.raster_ms /= static_cast<double>(impls_.size());
  if (!from_gaps) return all;
  sort_numbers(std::span(all.gaps.lit));
  sort_numbers(std::span(all.gaps.shadowed));
  all.best = compare::find_best_bias(all.gaps);
  all.bias_at_best = compare::with_three_digits(
      compare::with_constant(setting.raster.map, all.best->constant_world, all.texel_world));
  for (const auto& impl : impls_) impl->add_figures_at(all.bias_at_best, measure, all);
  return all;
}

Expected<double> Engine::time_drawing(const Setting& setting) {
  double sum = 0.0;
  for (std::size_t view = 0; view < impls_.size(); ++view) {
    const auto ms = impls_[view]->time_drawing(posed(setting, view));
    if (!ms) return ms;
    sum += *ms;
  }
  return sum / static_cast<double>(impls_.size());
}

Expected<const std::vector<raster::LightRecord>*> Engine::time_again(const Setting& setting,
                                                                     std::size_t view) {
  const std::size_t seen = std::min(view, impls_.size() - 1);
  Impl& impl = *impls_[seen];
  if (auto timed = impl.time_again(posed(setting, seen)); !timed) return fail(timed.error());
  return &impl.comparison.raster.lights;
}

void Engine::begin_round() {
  for (const auto& impl : impls_) impl->timed_for.reset();
}

bool Engine::last_was_derived() const {
  return impls_[shown_]->derived;
}

const EngineWork& Engine::work() const {
  return kept_->work;
}

void Engine::expect_biases(std::vector<raster::Bias> biases) {
  kept_->expected = std::move(biases);
  for (const auto& impl : impls_) impl->table.clear();
}

void Engine::film_with(const compare::FilmPlan& plan) {
  kept_->film = plan;
}

Expected<std::vector<compare::ShimmerFigures>> Engine::Impl::count_flips(const Setting& setting) const {
  ShimmerOptions options{*film, {}};
  options.compare.raster = setting.raster;
  options.compare.raytrace = setting.raytrace;
  options.compare.accel = setting.accel, options.compare.precision = setting.precision;
  return studies::count_flips({*tracer, topology, comparison.raytraced}, world, scene, renderer,
                              setting.compared, options);
}

Expected<void> Engine::compare_view(std::size_t view, const Setting& setting, Detail detail) {
  Impl& impl = *impls_[view];
  if (auto compared = impl.compare(setting, detail); !compared) return compared;
  impl.comparison.views = {};
  if (!impl.film) return {};
  const auto flips = impl.count_flips(setting);
  if (!flips) return fail(flips.error());
  for (std::size_t i = 0; i < flips->size(); ++i) impl.comparison.lights[i].shimmer = (*flips)[i];
  return {};
}

Expected<compare::Comparison*> Engine::compare(const Setting& setting, Detail detail) {
  shown_ = 0;
  compare::ViewErrors errors{.measure = measure_};
  const bool maps = maps_places_ && !views_.empty() && detail == Detail::images;
  kept_->places.reset();
  if (maps) kept_->places = compare::places_of(kept_->world, setting.camera);
  for (std::size_t view = 0; view < impls_.size(); ++view) {
    const Detail enough = views_.empty() || maps ? detail : Detail::numbers;
    if (auto compared = compare_view(view, posed(setting, view), enough); !compared)
      return fail(compared.error());
    if (!views_.empty() && compare::add_view(errors, views_[view].name, impls_[view]->comparison))
      shown_ = view;
  }
  if (maps) errors.places = std::move(*kept_->places);
  kept_->places.reset();
  Impl& worst = *impls_[shown_];
  const Setting shown = posed(setting, shown_);
  kept_->scene.camera = shown.camera, kept_->scene.lights = shown.lights;
  if (!views_.empty() && detail == Detail::images && !worst.has_images)
    if (auto again = compare_view(shown_, shown, detail); !again) return fail(again.error());
  worst.comparison.views = std::move(errors);
  return &worst.comparison;
}

}  // namespace gnomon::studies
