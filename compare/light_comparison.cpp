#include "compare/light_comparison.h"

#include "compare/bias_curve.h"
#include "compare/bias_kinds.h"
#include "compare/bleeding.h"
#include "compare/budget.h"
#include "compare/cascades.h"
#include "compare/edges.h"
#include "compare/flip.h"
#include "compare/light_parts.h"
#include "compare/penumbra.h"
#include "compare/shadow_cost.h"
#include "compare/shown_materials.h"
#include "compare/ssim.h"
#include "compare/theory.h"
#include "scene/stages.h"

namespace gnomon::compare {
namespace {

// On another renderer's map, too, Gnomon's own kinds are tried.
std::vector<BiasKind> kinds_of_bias(const LadderInput& in, const Image<float>& truth,
                                    const Image<Label>& labels) {
  if (!in.record.captured) return compare_bias_kinds(in, truth, labels);
  raster::LightRecord record = in.record;
  record.captured.reset();
  return compare_bias_kinds(
      {in.world, in.tracer, in.topology, in.light, in.drawn, record, in.traced, in.truth}, truth, labels);
}

}  // namespace

void measure_pixels(LightComparison& light) {
  light.pixels = count_pixels(light.labels);
  light.classes = count_classes(light.labels);
  light.error = measure_error(light.rungs, light.labels);
  light.budget = add_up_budget(light.rungs, light.labels);
  light.accidents = count_accidents(light.rungs, light.labels);
  light.rung_mean = mean_rungs(light.rungs, light.labels);
}

void measure_perceptual(LightComparison& light) {
  const Image<float> truth = visibility_picture(light.rungs[0], light.labels);
  const Image<float> drawn = visibility_picture(light.rungs[6], light.labels);
  light.flip_map = flip_error(truth, drawn);
  light.error.flip = mean_flip(light.flip_map);
  const Image<float> windows = ssim_map(truth, drawn);
  light.error.ssim = mean_ssim(windows);
  light.ssim_map = ssim_by_pixel(windows, truth.size);
  ComparedMean flip, ssim;
  flip.add(light.flip_map, light.labels), ssim.add(light.ssim_map, light.labels);
  light.error.flip_compared = flip.mean(), light.error.ssim_compared = ssim.mean();
}

ErrorFigures measure_figures(const LadderInput& in, ErrorMeasure measure) {
  LightComparison light;
  light.labels = sort_pixels(in);
  const Image<Label> climbed = labels_climbed(in, light.labels);
  Image<float>&truth = light.rungs.front(), &drawn = light.rungs.back();
  truth = drawn = Image<float>(light.labels.size, 1.0f);
  for (std::size_t i = 0; i < climbed.data.size(); ++i) {
    if (!is_compared(climbed.data[i])) continue;
    truth.data[i] = true_visibility(in, i);
    drawn.data[i] = in.record.visibility.data[i];
  }
  light.pixels = count_pixels(light.labels);
  light.pixels.uncertain_by_samples = count_pixels(climbed).compared - light.pixels.compared;
  light.error = measure_error(light.rungs, light.labels);
  if (measure == ErrorMeasure::flip) measure_perceptual(light);
  light.edges.rms_texels = std::numeric_limits<double>::quiet_NaN();
  if (measure == ErrorMeasure::edge)
    light.edges = measure_edges({in.drawn, in.record, in.traced.receiver, truth, climbed, in.world});
  return figures_of(light);
}

MapMeasures measure_map(const LadderInput& in, const Image<Label>& labels) {
  std::vector<double> widths = texel_widths(in, labels);
  return {low_middle_high(widths), predict(in, labels)};
}

LightComparison measure_light(const LadderInput& in, std::size_t record, Climb climbed,
                              const MeasureOptions& options) {
  const TimedStage stage("metrics");
  LightComparison out;
  out.light = in.record.light;
  out.record = record;
  out.rungs = std::move(climbed.rungs);
  out.labels = std::move(climbed.labels);
  measure_pixels(out);
  if (options.perceptual) measure_perceptual(out);
  const Image<float>& truth = out.rungs[0];
  const Image<Label> climbed_labels = labels_climbed(in, out.labels);
  const EdgeInput edges{in.drawn, in.record, in.traced.receiver, truth, climbed_labels, in.world};
  out.edges = measure_edges(edges);
  if (options.perceptual) out.edge_map = edge_displacement_map(edges);
  Image<float> detached = detachment_map(in.tracer, in.light, in.traced.receiver, out.labels);
  out.detachment = measure_detachment(detached);
  if (options.perceptual) {
    out.detachment_map = std::move(detached);
    out.stored_glass = stored_glass(in.tracer, in.record, in.drawn.options.map, in.traced.receiver);
  }
  out.bleeding = measure_bleeding(in, out.rungs, out.labels);
  if (!in.truth.visibility.data.empty()) {
    out.pixels.uncertain_by_samples = count_pixels(climbed_labels).compared - out.pixels.compared;
    out.penumbra = measure_penumbra(in, truth, climbed_labels);
    StandardErrors errors;
    errors.add(in.truth, out.labels);
    errors.put(*out.penumbra);
  }
  const MapMeasures map = options.map != nullptr ? *options.map : measure_map(in, out.labels);
  out.texel_world = map.texel_world;
  out.theory = map.theory;
  out.bias_texel_world = in.record.texel_world;
  out.seams = count_seams(in, out.labels);
  out.lookups = count_lookups(in.drawn, in.record, out.labels);
  if (options.perceptual) out.ray_work = count_ray_work(in.tracer, in.light, in.traced.receiver, out.labels);
  out.bias_curve_withheld = why_no_curve(in.drawn, in.record);
  if (!out.bias_curve_withheld.empty()) return out;
  const TimedStage curve("curve");
  const GapLists gaps = sort_gaps(in.record, truth, out.labels);
  out.best_bias = find_advised_bias(gaps);
  if (options.perceptual) out.bias_kinds = kinds_of_bias(in, truth, out.labels);
  out.bias_curve = draw_bias_curve(gaps, out.bias_texel_world, in.record.bias_constant_world,
                                   out.best_bias.constant_world, options.bias_curve_points);
  return out;
}

}  // namespace gnomon::compare
