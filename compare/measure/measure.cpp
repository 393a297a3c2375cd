#include "compare/measure/measure.h"

#include <algorithm>

#include "compare/measure/pictures.h"
#include "compare/measure/shaded.h"
#include "compare/measure/sums.h"
#include "compare/result/figures.h"
#include "compare/result/places.h"
#include "raster/bands.h"
#include "raster/technique_traits.h"
#include "raytrace/frame.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

/// A light's list on the disk beyond this.
constexpr std::size_t most_kept_in_bands = std::size_t{1} << 16;  // bytes

/// The work from the first band to the last.
class Measuring {
 public:
  Measuring(Comparison& out, const Plan& plan, const FrameSource& source, const raytrace::Topology& topology,
            ImageSink& images, const Progress& progress)
      : out_(out), plan_(plan), source_(source), topology_(topology), images_(images), progress_(progress) {
    for (std::size_t i = 0; i < plan.lights.size(); ++i) {
      MeasureOptions options = plan.measure;
      if (!plan.maps.empty()) options.map = &plan.maps[i];
      if (!in_one_piece()) options.spill = {plan.folder, most_kept_in_bands};
      sums_.emplace_back(options, plan.picture);
    }
    classify_ms_.resize(plan.lights.size());
  }

  Expected<void> add(const PictureRows& rows);
  Expected<void> finish();

 private:
  bool in_one_piece() const { return plan_.bands.size() <= 1; }
  void report(std::string_view stage, double done) const {
    if (progress_ && in_one_piece()) progress_(stage, done);
  }
  LadderInput input(const Frames& frames, std::size_t light, int first_row) const {
    return {plan_.tracer, topology_, frames.drawn, frames.traced, light, {first_row, plan_.picture.height}};
  }
  Expected<void> add_light(std::size_t light, const Frames& band, const PictureRows& rows,
                           const PictureRows& ready);
  Expected<void> finish_light(const LadderInput& in);

  Comparison& out_;
  const Plan& plan_;
  const FrameSource& source_;
  const raytrace::Topology& topology_;
  ImageSink& images_;
  const Progress& progress_;
  std::vector<LightSums> sums_;
  std::vector<double> classify_ms_;
  NearRows near_;
  int measured_ = 0;  ///< rows that have all that they depend on
};

Expected<void> Measuring::add(const PictureRows& rows) {
  auto drawn = source_.draw(rows);
  if (!drawn) return fail(drawn.error());
  report("ray tracing", 0.3);
  auto traced = source_.trace(rows);
  if (!traced) return fail(traced.error());
  report("comparing", 0.7);
  Frames band{std::move(*drawn), std::move(*traced)};
  near_.add(band, plan_.picture);
  const bool last = rows.end() == plan_.picture.height;
  const int end = last ? rows.end() : std::max(measured_, rows.end() - edge_margin);
  for (std::size_t i = 0; i < sums_.size(); ++i)
    if (const auto added = add_light(i, band, rows, {measured_, end - measured_}); !added) return added;
  measured_ = end;
  if (last)
    near_.forget_images();
  else
    near_.forget_above(std::max(0, measured_ - edge_margin));
  return images_.keep_frames(std::move(band), rows);
}

/// `ready`: the rows whose neighbours are there with these.
Expected<void> Measuring::add_light(std::size_t i, const Frames& band, const PictureRows& rows,
                                    const PictureRows& ready) {
  const LadderInput in = input(band, i, rows.first);
  const Stopwatch classify;
  Climb climbed = source_.climb ? source_.climb(in) : climb(in, sort_pixels(in));
  classify_ms_[i] += classify.elapsed_ms();
  const Image<Label> labels = labels_climbed(in, climbed.labels);
  if (plan_.places != nullptr)
    add_errors(band.traced.receiver, climbed.labels, climbed.rungs.front(), climbed.rungs.back(),
               *plan_.places);
  if (plan_.subpixels != nullptr) plan_.subpixels->add(i, rows.first, climbed);
  const NearLight near = near_.add(i, climbed, labels);
  auto maps = sums_[i].add_neighbours(input(near_.frames(), i, near_.first()), near, ready);
  if (!maps) return fail(maps.error());
  if (const auto kept = images_.keep_maps(i, std::move(*maps), ready); !kept) return kept;
  auto detached = sums_[i].add_pixels(in, climbed, labels);
  if (!detached) return fail(detached.error());
  if (const auto kept = images_.keep_light(in, std::move(climbed), std::move(*detached), rows); !kept)
    return kept;
  // One light's lists are gone before the next one's are made; those of bands are on the disk.
  return in_one_piece() ? finish_light(in) : Expected<void>{};
}

Expected<void> Measuring::finish_light(const LadderInput& in) {
  LightComparison& light = out_.lights[in.index];
  light.classify.runs = {classify_ms_[in.index]};
  return sums_[in.index].finish(in, light);
}

Expected<void> Measuring::finish() {
  for (std::size_t i = 0; !in_one_piece() && i < sums_.size(); ++i)
    if (const auto done = finish_light(input(near_.frames(), i, near_.first())); !done) return done;
  const auto exposure = images_.exposure();
  if (!exposure) return fail(exposure.error());
  out_.exposure = *exposure;
  if (plan_.measure.perceptual && in_one_piece()) out_.shaded = shaded_error(out_);
  return {};
}

}  // namespace

raster::RasterOptions drawing_options(raster::RasterOptions drawing,
                                      const raytrace::RaytraceOptions& traced) {
  drawing.seed = traced.seed, drawing.shadow_samples = traced.shadow_samples;
  return drawing;
}

Expected<std::unique_ptr<BandedParts>> measure(Comparison& out, const Plan& plan, const FrameSource& source,
                                               const Progress& progress) {
  const World& world = plan.tracer.world();
  out.world = &world;
  out.threads = threads_in_use();
  out.plan = plan_effects(*world.scene);
  out.precision = plan.tracer.precision();
  out.lights.assign(plan.lights.size(), {});
  for (std::size_t i = 0; i < plan.lights.size(); ++i) out.lights[i].light = plan.lights[i];
  std::optional<raytrace::Topology> joined;
  const Stopwatch joining;
  if (plan.topology == nullptr) joined.emplace(world), out.topology_ms = joining.elapsed_ms();
  std::unique_ptr<BandedParts> parts;
  if (plan.bands.size() > 1)
    parts = std::make_unique<BandedParts>(BandedParts{{plan.picture, plan.lights.size()}, {}});
  const auto images = make_sink(out, plan, parts.get());
  Measuring work(out, plan, source, joined ? *joined : *plan.topology, *images, progress);
  const std::vector<PictureRows> whole{{0, plan.picture.height}};
  for (const PictureRows& rows : parts ? plan.bands : whole) {
    if (progress && parts) progress("comparing in bands", double(rows.first) / plan.picture.height);
    if (const auto added = work.add(rows); !added) return fail(added.error());
  }
  if (const auto finished = work.finish(); !finished) return fail(finished.error());
  if (progress) progress("compared", 1.0);
  return parts;
}

Expected<void> measure_frames(Comparison& comparison, const Plan& plan,
                              const std::function<Climb(const LadderInput&)>& climb) {
  const FrameSource there{
      [&](const PictureRows&) { return Expected<raster::RasterFrame>(std::move(comparison.raster)); },
      [&](const PictureRows&) { return Expected<raytrace::RayTracedFrame>(std::move(comparison.raytraced)); },
      climb};
  const auto measured = measure(comparison, plan, there);
  if (!measured) return fail(measured.error());
  return {};
}

FrameSource frames_of(const raytrace::Tracer& tracer, raster::Renderer& renderer,
                      std::span<const std::uint32_t> lights, const CompareOptions& options) {
  const ImageSize size = options.raster.size;
  const Scene& scene = *tracer.world().scene;
  const EffectPlan effects = plan_effects(scene);
  const auto in_bands = [size](const PictureRows& rows) { return rows.count < size.height; };
  const auto draw = [=, &renderer, &options](const PictureRows& rows) {
    if (in_bands(rows)) raster::set_rows(renderer, rows);
    auto drawn = renderer.render(drawing_options(options.raster, options.raytrace), lights);
    if (in_bands(rows)) raster::set_rows(renderer, std::nullopt);
    return drawn;
  };
  const auto trace = [=, &tracer, &scene,
                      &options](const PictureRows& rows) -> Expected<raytrace::RayTracedFrame> {
    if (!in_bands(rows))
      return raytrace::trace_frame(tracer, effects, scene.camera, lights, options.raytrace);
    raytrace::RaytraceOptions band = options.raytrace;
    band.warm_up = band.warm_up && rows.first == 0;
    return raytrace::trace_band(tracer, effects, scene.camera, lights, band, rows);
  };
  return {draw, trace};
}

bool is_timed_later(const raster::RasterOptions& options) {
  return options.runs > 0 && !options.timed_as_judged && !raster::is_external(options.map.technique);
}

raster::RasterOptions untimed(raster::RasterOptions options) {
  options.runs = 0, options.shadow_cost = false;
  return options;
}

Expected<void> time_drawing(raster::Renderer& renderer, std::span<const std::uint32_t> lights,
                            const raster::RasterOptions& options, raster::RasterFrame& frame) {
  raster::RasterOptions times = options;
  times.analysis = false, times.times_alone = true;
  auto timed = renderer.render(times, lights);
  if (!timed) return fail(timed.error());
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    raster::LightRecord &drawn = frame.lights[i], &by_time = timed->lights[i];
    drawn.map_pass = std::move(by_time.map_pass), drawn.shade_pass = std::move(by_time.shade_pass);
    drawn.unshadowed_pass = std::move(by_time.unshadowed_pass), drawn.strips = std::move(by_time.strips);
  }
  frame.options.runs = options.runs, frame.options.shadow_cost = options.shadow_cost;
  return {};
}

LightFigures measure_ends(const LadderInput& in, std::initializer_list<const Figure*> measures) {
  const auto needs = [&](FigureNeeds what) {
    return std::any_of(measures.begin(), measures.end(),
                       [&](const Figure* one) { return one->needs == what; });
  };
  LightFigures light;
  const Image<Label> labels = sort_pixels(in);
  const Image<Label> climbed = labels_climbed(in, labels);
  Image<float> truth(labels.size, 1.0f), drawn = truth;
  for (std::size_t i = 0; i < climbed.data.size(); ++i) {
    if (!is_compared(climbed.data[i])) continue;
    truth.data[i] = true_visibility(in, i);
    drawn.data[i] = in.record().visibility.data[i];
  }
  PixelSums sums;
  sums.add_ends(truth, drawn, labels);
  light.pixels = sums.pixels();
  light.pixels.uncertain_by_samples = count_pixels(climbed).compared - light.pixels.compared;
  light.error = sums.terms().error();
  const PictureRows all{0, labels.size.height};
  if (needs(FigureNeeds::perception)) {
    Perception perception;
    MetricMaps maps;
    perception.add({truth, drawn, labels, climbed}, 0, all, all.count, maps);
    perception.write_to(light.error);
  }
  light.edges.rms_texels = std::numeric_limits<double>::quiet_NaN();
  if (needs(FigureNeeds::edges)) {
    EdgeSums edges;
    add_edges({in.drawn, in.record(), in.traced.receiver, truth, climbed, in.world()}, all, edges);
    light.edges = edges.stats();
    forget_unknown_edges(light, in.drawn.has_map());
  }
  return light;
}

}  // namespace gnomon::compare
