#include "compare/bands/bands.h"

#include <algorithm>

#include "compare/aov.h"
#include "compare/bands/run_all.h"
#include "compare/output_parts.h"
#include "compare/reduced.h"
#include "compare/shown_materials.h"
#include "raster/bands.h"
#include "raytrace/band.h"
#include "scene/exposure.h"
#include "scene/parallel.h"
#include "scene/stages.h"

namespace gnomon::compare {
namespace {

/// In the time budget, what bands cost alone.
constexpr std::string_view band_stage = "rows kept";

/// The work from the first band to the last.
class BandedWork {
 public:
  BandedWork(const BandedInput& in, const raytrace::Topology& topology, BandedComparison& out)
      : in_(in), topology_(topology), out_(out), step_{image_step(size()), size().height} {
    for (std::size_t i = 0; i < in.lights.size(); ++i)
      measures_.emplace_back(in.folder, in.options.bias_curve_points, in.options.perceptual);
    classify_.resize(in.lights.size());
    out_.comparison.lights.resize(in.lights.size());
    for (std::size_t i = 0; i < in.lights.size(); ++i) out_.comparison.lights[i].light = in.lights[i];
    if (in.aov.empty()) return;
    for (const LightComparison& light : out_.comparison.lights)
      out_.parts->channels.emplace_back(aov_path(out_.comparison, light, in.aov), size());
  }

  Expected<void> add(const PictureRows& rows);
  Expected<void> finish();

 private:
  const Scene& scene() const { return *in_.tracer.world().scene; }
  ImageSize size() const { return in_.options.raster.size; }
  PictureStore& store() { return out_.parts->pictures; }
  const Light& light(std::size_t i) const { return scene().lights[in_.lights[i]]; }
  Expected<raster::RasterFrame> draw(const PictureRows& rows);
  raytrace::RayTracedFrame trace(const PictureRows& rows);
  Expected<NearLight> climb_light(std::size_t i, const raster::RasterFrame& drawn,
                                  const raytrace::RayTracedFrame& traced, const PictureRows& rows);
  Expected<void> keep(const raster::RasterFrame& drawn, const raytrace::RayTracedFrame& traced,
                      const std::vector<NearLight>& lights, const PictureRows& rows);
  Expected<void> keep_light(const LadderInput& input, std::size_t i, const Climb& climbed,
                            const Image<float>& detached, const PictureRows& rows);
  Expected<void> keep_maps(std::size_t i, const FinishedMaps& maps, const PictureRows& rows);
  Expected<void> measure_neighbours(int end);
  Expected<void> finish_exposure();
  LadderInput near_input(std::size_t i) const {
    return {in_.tracer.world(),
            in_.tracer,
            topology_,
            light(i),
            near_.drawn,
            near_.drawn.lights[i],
            near_.traced,
            near_.traced.lights[i],
            {near_.first(), size().height}};
  }

  const BandedInput& in_;
  const raytrace::Topology& topology_;
  BandedComparison& out_;
  Reduction step_;    ///< of what the page shows
  int measured_ = 0;  ///< rows
  std::vector<LightMeasures> measures_;
  std::vector<double> classify_;  ///< ms, by light
  NearRows near_;
  AutoExposure exposure_;
  raster::RasterFrame raster_costs_;
  raytrace::RayTracedFrame ray_costs_;
};

Expected<raster::RasterFrame> BandedWork::draw(const PictureRows& rows) {
  raster::set_rows(in_.renderer, rows);
  auto drawn = in_.renderer.render(drawing_options(in_.options.raster, in_.options.raytrace), in_.lights);
  raster::set_rows(in_.renderer, std::nullopt);
  return drawn;
}

raytrace::RayTracedFrame BandedWork::trace(const PictureRows& rows) {
  raytrace::RaytraceOptions options = in_.options.raytrace;
  options.warm_up = options.warm_up && rows.first == 0;
  return raytrace::trace_band(in_.tracer, out_.comparison.plan, scene().camera, in_.lights, options, rows);
}

Expected<void> BandedWork::add(const PictureRows& rows) {
  auto drawn = draw(rows);
  if (!drawn) return fail(drawn.error());
  const raytrace::RayTracedFrame traced = trace(rows);
  raster::add_costs(*drawn, raster_costs_);
  raytrace::add_costs(traced, ray_costs_);
  std::vector<NearLight> lights;
  for (std::size_t i = 0; i < in_.lights.size(); ++i) {
    auto near = climb_light(i, *drawn, traced, rows);
    if (!near) return fail(near.error());
    lights.push_back(std::move(*near));
  }
  if (const auto kept = keep(*drawn, traced, lights, rows); !kept) return kept;
  const bool last = rows.end() == size().height;
  return measure_neighbours(last ? rows.end() : std::max(measured_, rows.end() - edge_margin));
}

/// What of the band is needed later.
Expected<void> BandedWork::keep(const raster::RasterFrame& drawn, const raytrace::RayTracedFrame& traced,
                                const std::vector<NearLight>& lights, const PictureRows& rows) {
  const TimedStage stage(band_stage);
  std::vector<Step> steps{[&] { return store().raster.append(in_.folder, drawn.color); },
                          [&] { return store().raytraced.append(in_.folder, traced.color); },
                          [&]() -> Expected<void> {
                            exposure_.count(traced.color.data);
                            near_.add(drawn, traced, lights);
                            return {};
                          }};
  if (in_.page)
    steps.emplace_back([&]() -> Expected<void> {
      append_reduced(out_.comparison.raster, drawn, rows.first, step_);
      append_reduced(out_.comparison, traced, rows.first, step_);
      return {};
    });
  return run_all(steps);
}

Expected<NearLight> BandedWork::climb_light(std::size_t i, const raster::RasterFrame& drawn,
                                            const raytrace::RayTracedFrame& traced, const PictureRows& rows) {
  const LadderInput input{in_.tracer.world(),
                          in_.tracer,
                          topology_,
                          light(i),
                          drawn,
                          drawn.lights[i],
                          traced,
                          traced.lights[i],
                          {rows.first, size().height}};
  const Stopwatch classify;
  Climb climbed = climb(input, sort_pixels(input));
  classify_[i] += classify.elapsed_ms();
  NearLight near;
  near.climbed = labels_climbed(input, climbed.labels);
  const auto detached = measures_[i].add_pixels(input, climbed, near.climbed, {size(), rows});
  if (!detached) return fail(detached.error());
  if (const auto kept = keep_light(input, i, climbed, *detached, rows); !kept) return fail(kept.error());
  if (!in_.aov.empty()) {
    const AovRows channels{in_.tracer.world(), drawn, drawn.lights[i], traced, climbed.rungs, climbed.labels};
    const auto written = out_.parts->channels[i].write(
        rows, aov_channels(channels), aov_attributes(out_.comparison, out_.comparison.lights[i]));
    if (!written) return fail(written.error());
  }
  near.truth = std::move(climbed.rungs.front()), near.drawn = std::move(climbed.rungs.back());
  near.labels = std::move(climbed.labels);
  return near;
}

Expected<void> BandedWork::keep_light(const LadderInput& input, std::size_t i, const Climb& climbed,
                                      const Image<float>& detached, const PictureRows& rows) {
  const TimedStage stage(band_stage);
  const raster::LightRecord& record = input.record;
  StoredLight& stored = store().lights[i];
  std::vector<Step> steps{[&] { return stored.truth.append(in_.folder, climbed.rungs.front()); },
                          [&] { return stored.drawn.append(in_.folder, climbed.rungs.back()); },
                          [&] { return stored.labels.append(in_.folder, climbed.labels); }};
  if (in_.options.perceptual)
    steps.emplace_back([&] { return stored.detachment.append(in_.folder, detached); });
  if (record.external)
    steps.emplace_back([&] { return stored.decisions.append(in_.folder, record.external->decision); });
  if (in_.page)
    steps.emplace_back([&]() -> Expected<void> {
      LightComparison& shown = out_.comparison.lights[i];
      for (std::size_t k = 0; k < rung_count; ++k)
        append_reduced(shown.rungs[k], climbed.rungs[k], rows.first, step_);
      append_reduced(shown.labels, climbed.labels, rows.first, step_);
      if (in_.options.perceptual) append_reduced(shown.detachment_map, detached, rows.first, step_);
      const Image<std::uint32_t> glass =
          stored_glass(input.tracer, record, input.drawn.options.map, input.traced.receiver);
      append_reduced(shown.stored_glass, glass, rows.first, step_);
      return {};
    });
  return run_all(steps);
}

/// Of the rows above `end`, which have all that they hang on.
Expected<void> BandedWork::measure_neighbours(int end) {
  const PictureRows rows{measured_, end - measured_};
  if (rows.count <= 0) return {};
  for (std::size_t i = 0; i < in_.lights.size(); ++i) {
    const auto maps =
        measures_[i].add_neighbours(near_input(i), near_.lights[i], near_.first(), {size(), rows});
    if (!maps) return fail(maps.error());
    if (const auto kept = keep_maps(i, *maps, rows); !kept) return kept;
  }
  measured_ = end;
  if (measured_ == size().height)
    near_.forget_images();
  else
    near_.forget_above(std::max(0, measured_ - edge_margin));
  return {};
}

Expected<void> BandedWork::keep_maps(std::size_t i, const FinishedMaps& maps, const PictureRows& rows) {
  const TimedStage stage(band_stage);
  StoredLight& stored = store().lights[i];
  std::vector<Step> steps{[&] { return stored.edges.append(in_.folder, maps.edges); },
                          [&] { return stored.flip.append(in_.folder, maps.flip); },
                          [&] { return stored.ssim.append(in_.folder, maps.ssim); }};
  if (in_.page)
    steps.emplace_back([&]() -> Expected<void> {
      LightComparison& shown = out_.comparison.lights[i];
      append_reduced(shown.edge_map, maps.edges, rows.first, step_);
      append_reduced(shown.flip_map, maps.flip, rows.first, step_);
      append_reduced(shown.ssim_map, maps.ssim, rows.first, step_);
      return {};
    });
  return run_all(steps);
}

Expected<void> BandedWork::finish_exposure() {
  if (scene().exposure) {
    out_.comparison.exposure = *scene().exposure;
    return {};
  }
  if (exposure_.choose()) {
    for (const PictureRows& rows : bands_of(size(), band_step)) {
      const auto color = store().raytraced.read(rows);
      if (!color) return fail(color.error());
      exposure_.collect(color->data);
    }
  }
  out_.comparison.exposure = exposure_.factor();
  return {};
}

Expected<void> BandedWork::finish() {
  Comparison& out = out_.comparison;
  for (std::size_t i = 0; i < in_.lights.size(); ++i) {
    LightComparison shown = std::move(out.lights[i]);
    auto light = measures_[i].finish(near_input(i), i);
    if (!light) return fail(light.error());
    light->rungs = std::move(shown.rungs), light->labels = std::move(shown.labels);
    light->edge_map = std::move(shown.edge_map), light->detachment_map = std::move(shown.detachment_map);
    light->flip_map = std::move(shown.flip_map), light->ssim_map = std::move(shown.ssim_map);
    light->stored_glass = std::move(shown.stored_glass);
    light->classify.runs = {classify_[i]};
    out.lights[i] = std::move(*light);
    out_.parts->cascades.push_back(measures_[i].cascades());
  }
  raster::RasterFrame shown = std::move(out.raster);
  out.raster = std::move(raster_costs_);
  out.raster.color = std::move(shown.color), out.raster.primitive = std::move(shown.primitive);
  for (std::size_t i = 0; i < out.raster.lights.size(); ++i) {
    raster::LightRecord& light = out.raster.lights[i];
    light.map = std::move(near_.drawn.lights[i].map);
    if (shown.lights.empty()) continue;
    light.texel_uv = std::move(shown.lights[i].texel_uv), light.face = std::move(shown.lights[i].face);
    light.distance = std::move(shown.lights[i].distance), light.gap = std::move(shown.lights[i].gap);
    if (light.external) light.external->decision = std::move(shown.lights[i].external->decision);
  }
  raytrace::RayTracedFrame traced = std::move(out.raytraced);
  out.raytraced = std::move(ray_costs_);
  out.raytraced.options = in_.options.raytrace;
  out.raytraced.color = std::move(traced.color);
  for (std::size_t i = 0; i < in_.lights.size(); ++i)  // says that the light has a size
    if (has_size(light(i))) out.raytraced.lights[i].visibility = Image<float>({1, 1});
  return finish_exposure();
}

}  // namespace

Expected<BandedComparison> compare_in_bands(const BandedInput& in, const Progress& progress) {
  BandedComparison out;
  const ImageSize size = in.options.raster.size;
  out.parts = std::make_unique<BandedParts>(BandedParts{{size, in.lights.size()}, {}, {}});
  Comparison& c = out.comparison;
  const World& world = in.tracer.world();
  c.world = &world;
  c.command = in.command;
  c.threads = threads_in_use();
  c.plan = plan_effects(*world.scene);
  c.precision = in.options.precision;
  c.accel_build_ms = in.tracer.stats().build_ms;
  const Stopwatch joining;
  const raytrace::Topology topology(world);
  c.topology_ms = joining.elapsed_ms();
  BandedWork work(in, topology, out);
  for (const PictureRows& rows : in.bands) {
    if (progress) progress("comparing in bands", double(rows.first) / size.height);
    if (const auto added = work.add(rows); !added) return fail(added.error());
  }
  if (const auto finished = work.finish(); !finished) return fail(finished.error());
  if (progress) progress("compared", 1.0);
  return out;
}

}  // namespace gnomon::compare
