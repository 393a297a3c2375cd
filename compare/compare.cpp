#include "compare/compare.h"

#include <tbb/global_control.h>

#include "compare/bias_curve.h"
#include "compare/budget.h"
#include "compare/edges.h"
#include "compare/flip.h"
#include "compare/ladder.h"
#include "scene/exposure.h"

namespace gnomon::compare {
namespace {

Expected<std::vector<std::uint32_t>> choose_lights(const Scene& scene, const std::string& name) {
  std::vector<std::uint32_t> lights;
  std::string known;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    if (name.empty() || scene.lights[i].name == name) lights.push_back(i);
    known += (i == 0 ? "" : ", ") + scene.lights[i].name;
  }
  if (!lights.empty()) return lights;
  return fail(ErrorKind::usage,
              "--light: the scene has no such light (got " + name + ", allowed " + known + ")");
}

// The visibility pictures that FLIP compares: white lit, black shadowed, white where nothing is compared.
ColorImage visibility_picture(const Image<float>& visibility, const Image<Label>& labels) {
  ColorImage picture(visibility.size, Vec3f(1.0f));
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    if (is_compared(labels.data[i])) picture.data[i] = Vec3f(visibility.data[i]);
  return picture;
}

std::array<double, 3> texel_sizes(const LadderInput& in, const Image<Label>& labels) {
  const LightView& view = in.record.map.view;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (!is_compared(labels.data[i])) continue;
    const Vec3& x = in.traced.receiver.data[i].position;
    sizes.push_back(texel_world_size(view, project_to_face(view, in.record.face.data[i], x).depth));
    if (view.projection == LightProjection::orthographic) break;  // one size for all
  }
  if (sizes.empty()) return {};
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const auto [low, high] = std::minmax_element(sizes.begin(), sizes.end());
  return {*low, *middle, *high};
}

LightComparison compare_light(const LadderInput& in, std::size_t record, int curve_points) {
  LightComparison out;
  out.light = in.record.light;
  out.record = record;
  time_run(out.classify, [&] {
    Climb climbed = climb(in, sort_pixels(in));
    out.rungs = std::move(climbed.rungs);
    out.labels = std::move(climbed.labels);
  });
  const Image<float>& truth = out.rungs[0];
  out.pixels = count_pixels(out.labels);
  out.classes = count_classes(out.labels);
  out.error = measure_error(out.rungs, out.labels);
  out.budget = add_up_budget(out.rungs, out.labels);
  out.error.flip =
      mean_flip(visibility_picture(truth, out.labels), visibility_picture(out.rungs[6], out.labels));
  out.edges = measure_edges(in.drawn, in.record, truth, out.labels, in.world);
  out.detachment = measure_detachment(in.tracer, in.light, in.traced.receiver, out.labels);
  out.texel_world = texel_sizes(in, out.labels);
  const GapLists gaps = sort_gaps(in.record, truth, out.labels);
  out.best_bias = find_best_bias(gaps);
  out.bias_curve = draw_bias_curve(gaps, out.texel_world[1], in.record.bias_constant_world,
                                   out.best_bias.constant_world, curve_points);
  return out;
}

}  // namespace

Expected<std::vector<LightComparison>> compare_frames(const World& world, const raytrace::Tracer& tracer,
                                                      const raster::RasterFrame& drawn,
                                                      const raytrace::RayTracedFrame& truth,
                                                      const CompareOptions& options) {
  const raytrace::Topology topology(world);
  std::vector<LightComparison> lights;
  for (std::size_t i = 0; i < drawn.lights.size(); ++i) {
    const Light& light = world.scene->lights[drawn.lights[i].light];
    const LadderInput input{world, tracer, topology, light, drawn, drawn.lights[i], truth, truth.lights[i]};
    lights.push_back(compare_light(input, i, options.bias_curve_points));
  }
  return lights;
}

Expected<Comparison> compare_world(const World& world, raster::Renderer& renderer,
                                   const CompareOptions& options, const Progress& progress) {
  const auto report = [&](std::string_view stage, double done) {
    if (progress) progress(stage, done);
  };
  const Scene& scene = *world.scene;
  auto lights = choose_lights(scene, options.light);
  if (!lights) return tl::unexpected(lights.error());

  Comparison out;
  out.world = &world;
  out.threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  out.plan = plan_effects(scene);
  report("shadow maps", 0.0);
  auto drawn = renderer.render(options.raster, *lights);
  if (!drawn) return tl::unexpected(drawn.error());
  out.raster = std::move(*drawn);

  report("ray tracing", 0.3);
  const raytrace::Tracer tracer(world, options.accel);
  out.accel_build_ms = tracer.stats().build_ms;
  out.raytraced = raytrace::trace_frame(tracer, out.plan, scene.camera, *lights, options.raytrace);

  report("comparing", 0.7);
  auto compared = compare_frames(world, tracer, out.raster, out.raytraced, options);
  if (!compared) return tl::unexpected(compared.error());
  out.lights = std::move(*compared);
  out.exposure = scene.exposure ? *scene.exposure : auto_exposure(out.raytraced.color);
  report("compared", 1.0);
  return out;
}

}  // namespace gnomon::compare
