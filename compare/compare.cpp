#include "compare/compare.h"

#include "compare/light_comparison.h"
#include "scene/exposure.h"
#include "scene/parallel.h"

namespace gnomon::compare {

Expected<std::vector<LightComparison>> compare_frames(const World& world, const raytrace::Tracer& tracer,
                                                      const raster::RasterFrame& drawn,
                                                      const raytrace::RayTracedFrame& truth,
                                                      const CompareOptions& options, double* topology_ms) {
  const Stopwatch joining;
  const raytrace::Topology topology(world);
  if (topology_ms != nullptr) *topology_ms = joining.elapsed_ms();
  std::vector<LightComparison> lights;
  for (std::size_t i = 0; i < drawn.lights.size(); ++i) {
    const Light& light = world.scene->lights[drawn.lights[i].light];
    const LadderInput input{world, tracer, topology, light, drawn, drawn.lights[i], truth, truth.lights[i]};
    Times classify;
    Climb climbed;
    time_run(classify, [&] { climbed = climb(input, sort_pixels(input)); });
    lights.push_back(
        measure_light(input, i, std::move(climbed), {options.bias_curve_points, options.perceptual}));
    lights.back().classify = classify;
  }
  return lights;
}

raster::RasterOptions drawing_options(raster::RasterOptions drawing,
                                      const raytrace::RaytraceOptions& traced) {
  drawing.seed = traced.seed, drawing.shadow_samples = traced.shadow_samples;
  return drawing;
}

Expected<Comparison> compare_drawn(const raytrace::Tracer& tracer, raster::RasterFrame drawn,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress) {
  const auto report = [&](std::string_view stage, double done) {
    if (progress) progress(stage, done);
  };
  const World& world = tracer.world();
  const Scene& scene = *world.scene;
  Comparison out;
  out.world = &world;
  out.threads = threads_in_use();
  out.plan = plan_effects(scene);
  out.raster = std::move(drawn);

  report("ray tracing", 0.3);
  out.precision = options.precision;
  out.accel_build_ms = tracer.stats().build_ms;
  out.raytraced = raytrace::trace_frame(tracer, out.plan, scene.camera, lights, options.raytrace);

  report("comparing", 0.7);
  auto compared = compare_frames(world, tracer, out.raster, out.raytraced, options, &out.topology_ms);
  if (!compared) return tl::unexpected(compared.error());
  out.lights = std::move(*compared);
  out.exposure = scene.exposure ? *scene.exposure : auto_exposure(out.raytraced.color);
  report("compared", 1.0);
  return out;
}

Expected<Comparison> compare_world(const World& world, raster::Renderer& renderer,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress) {
  const raytrace::Tracer tracer(world, options.accel, options.precision);
  auto drawn = renderer.render(drawing_options(options.raster, options.raytrace), lights);
  if (!drawn) return tl::unexpected(drawn.error());
  return compare_drawn(tracer, std::move(*drawn), lights, options, progress);
}

}  // namespace gnomon::compare
