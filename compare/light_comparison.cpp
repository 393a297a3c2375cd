#include "compare/light_comparison.h"

#include <tbb/parallel_for.h>

#include "compare/bias_curve.h"
#include "compare/bias_kinds.h"
#include "compare/bleeding.h"
#include "compare/budget.h"
#include "compare/cascades.h"
#include "compare/edges.h"
#include "compare/flip.h"
#include "compare/option_names.h"
#include "compare/penumbra.h"
#include "compare/pixel_list.h"
#include "compare/shadow_cost.h"
#include "compare/ssim.h"
#include "compare/sweep/engine.h"
#include "compare/theory.h"
#include "scene/stages.h"

namespace gnomon::compare {
namespace {

// Of the compared pixels that have a value; NaN of none.
double mean_compared(const Image<float>& map, const Image<Label>& labels) {
  double sum = 0.0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < map.data.size(); ++i) {
    if (!is_compared(labels.data[i]) || std::isnan(map.data[i])) continue;
    sum += double{map.data[i]};
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

// White lit, black shadowed, white where nothing is compared. Where the truth is uncertain the rungs have
// what is known of it, or are white both.
Image<float> visibility_picture(const Image<float>& visibility, const Image<Label>& labels) {
  Image<float> picture(visibility.size, 1.0f);
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    if (is_compared(labels.data[i]) || labels.data[i] == Label::uncertain)
      picture.data[i] = visibility.data[i];
  return picture;
}

// Of the samples of partly lit compared pixels.
void add_standard_error(const raytrace::LightTruth& truth, const Image<Label>& labels, PenumbraStats& out) {
  std::uint64_t count = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const float share = truth.visibility.data[i];
    if (!is_compared(labels.data[i]) || share <= 0.0f || share >= 1.0f) continue;
    const double error = double{truth.standard_error.data[i]};
    sum += error;
    out.standard_error_max = std::max(out.standard_error_max, error);
    ++count;
  }
  if (count > 0) out.standard_error_mean = sum / static_cast<double>(count);
}

bool has_one_texel_size(const LightView& view) {
  return view.projection == LightProjection::orthographic && view.face_count == 1 && view.face(0).warp == 0.0;
}

// On another renderer's map, too, Gnomon's own kinds are tried.
std::vector<BiasKind> kinds_of_bias(const LadderInput& in, const Image<float>& truth,
                                    const Image<Label>& labels) {
  if (!in.record.captured) return compare_bias_kinds(in, truth, labels);
  raster::LightRecord record = in.record;
  record.captured.reset();
  return compare_bias_kinds(
      {in.world, in.tracer, in.topology, in.light, in.drawn, record, in.traced, in.truth}, truth, labels);
}

std::array<double, 3> texel_sizes(const LadderInput& in, const Image<Label>& labels) {
  const LightView& view = in.record.map.view;
  std::vector<std::uint32_t> pixels =
      pixels_where(labels.data.size(), [&](std::size_t i) { return is_compared(labels.data[i]); });
  if (pixels.empty()) return {};
  if (has_one_texel_size(view)) pixels.erase(pixels.begin() + 1, pixels.end());
  std::vector<double> sizes(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const Vec3& x = in.traced.receiver.data[pixels[i]].position;
    sizes[i] = texel_world_size(view, project_to_face(view, in.record.face.data[pixels[i]], x));
  });
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const auto [low, high] = std::minmax_element(sizes.begin(), sizes.end());
  return {*low, *middle, *high};
}

// A sentence, or nothing where a hard test drew, whose gaps say what every other constant bias would draw.
std::string_view why_no_curve(const raster::RasterFrame& drawn, const raster::LightRecord& record) {
  if (record.captured && !drawn.custom_shader)
    return record.captured->unit_world == 0.0
               ? std::string_view("The picture came without its map: there are no gaps to follow.")
               : std::string_view();
  if (biases_follow_from_gaps(drawn)) return {};
  if (drawn.custom_shader)
    return "A shader of --shader-dir drew this: what it would draw with another bias does not follow from "
           "one "
           "drawing.";
  if (!compares_depths(drawn.options.map.technique))
    return "This technique compares no stored depths: a bias does not change what it draws.";
  return "This technique filters: what it would draw with another bias does not follow from one drawing; a "
         "sweep over --bias draws each.";
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
  light.error.flip_compared = mean_compared(light.flip_map, light.labels);
  light.error.ssim_compared = mean_compared(light.ssim_map, light.labels);
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
  return {texel_sizes(in, labels), predict(in, labels)};
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
  if (options.perceptual) out.detachment_map = std::move(detached);
  out.bleeding = measure_bleeding(in, out.rungs, out.labels);
  if (!in.truth.visibility.data.empty()) {
    out.pixels.uncertain_by_samples = count_pixels(climbed_labels).compared - out.pixels.compared;
    out.penumbra = measure_penumbra(in, truth, climbed_labels);
    add_standard_error(in.truth, out.labels, *out.penumbra);
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
  out.best_bias = find_best_bias(gaps);
  if (options.perceptual) out.bias_kinds = kinds_of_bias(in, truth, out.labels);
  out.bias_curve = draw_bias_curve(gaps, out.bias_texel_world, in.record.bias_constant_world,
                                   out.best_bias.constant_world, options.bias_curve_points);
  return out;
}

}  // namespace gnomon::compare
