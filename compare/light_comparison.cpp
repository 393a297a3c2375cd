#include "compare/light_comparison.h"

#include "compare/bias_curve.h"
#include "compare/bleeding.h"
#include "compare/budget.h"
#include "compare/edges.h"
#include "compare/flip.h"
#include "compare/penumbra.h"
#include "compare/ssim.h"
#include "compare/theory.h"

namespace gnomon::compare {
namespace {

// White lit, black shadowed, white where nothing is compared.
Image<float> visibility_picture(const Image<float>& visibility, const Image<Label>& labels) {
  Image<float> picture(visibility.size, 1.0f);
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    if (is_compared(labels.data[i])) picture.data[i] = visibility.data[i];
  return picture;
}

bool has_one_texel_size(const LightView& view) {
  return view.projection == LightProjection::orthographic && view.face_count == 1 && view.face(0).warp == 0.0;
}

std::array<double, 3> texel_sizes(const LadderInput& in, const Image<Label>& labels) {
  const LightView& view = in.record.map.view;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (!is_compared(labels.data[i])) continue;
    const Vec3& x = in.traced.receiver.data[i].position;
    sizes.push_back(texel_world_size(view, project_to_face(view, in.record.face.data[i], x)));
    if (has_one_texel_size(view)) break;
  }
  if (sizes.empty()) return {};
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const auto [low, high] = std::minmax_element(sizes.begin(), sizes.end());
  return {*low, *middle, *high};
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
}

MapMeasures measure_map(const LadderInput& in, const Image<Label>& labels) {
  return {texel_sizes(in, labels), predict(in, labels)};
}

LightComparison measure_light(const LadderInput& in, std::size_t record, Climb climbed,
                              const MeasureOptions& options) {
  LightComparison out;
  out.light = in.record.light;
  out.record = record;
  out.rungs = std::move(climbed.rungs);
  out.labels = std::move(climbed.labels);
  measure_pixels(out);
  if (options.perceptual) measure_perceptual(out);
  const Image<float>& truth = out.rungs[0];
  const EdgeInput edges{in.drawn, in.record, in.traced.receiver, truth, out.labels, in.world};
  out.edges = measure_edges(edges);
  if (options.perceptual) out.edge_map = edge_displacement_map(edges);
  Image<float> detached = detachment_map(in.tracer, in.light, in.traced.receiver, out.labels);
  out.detachment = measure_detachment(detached);
  if (options.perceptual) out.detachment_map = std::move(detached);
  out.bleeding = measure_bleeding(in, out.rungs, out.labels);
  if (!in.truth.visibility.data.empty()) out.penumbra = measure_penumbra(in, truth, out.labels);
  const MapMeasures map = options.map != nullptr ? *options.map : measure_map(in, out.labels);
  out.texel_world = map.texel_world;
  out.theory = map.theory;
  if (in.drawn.custom_shader) return out;  // what it draws does not follow from the gaps
  const GapLists gaps = sort_gaps(in.record, truth, out.labels);
  out.best_bias = find_best_bias(gaps);
  out.bias_curve = draw_bias_curve(gaps, out.texel_world[1], in.record.bias_constant_world,
                                   out.best_bias.constant_world, options.bias_curve_points);
  return out;
}

}  // namespace gnomon::compare
