#include "raytrace/forecast.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/frame.h"
#include "raytrace/packets/blocks.h"
#include "scene/light.h"

namespace gnomon::raytrace {
namespace {

constexpr double grid_pixels = 8192.0;
/// Is how many rays a forecast may cost; with more samples there are fewer pixels.
constexpr double most_rays = 2e8;

/// What a pixel may cost: rough surfaces split a ray into samples, and each of those asks for lights and for
/// what they indirectly light.
double rays_of_a_pixel(const Tracer& tracer, const EffectPlan& plan, const RaytraceOptions& options) {
  const Scene& scene = *tracer.world().scene;
  double lights = 1.0;
  for (const Light& light : scene.lights)
    lights += plan.simulates(Effect::soft_shadow) && has_size(light) ? samples_of(light, options) : 1;
  const double glossy = plan.simulates(Effect::glossy) ? scene.glossy_samples : 1.0;
  const double indirect = plan.simulates(Effect::indirect_light) ? scene.indirect_samples : 0.0;
  return options.samples_per_pixel * glossy * (lights + indirect);
}

int coarse(int side, double step) {
  return std::max(1, static_cast<int>(std::lround(side / step)));
}

/// Rows of blocks, spread evenly; at least three, and all of a small picture.
std::vector<PictureRows> sampled_rows(const ImageSize& size) {
  constexpr int most_pixels = 1 << 18;
  const int all = (size.height + block_pixels - 1) / block_pixels;
  const int wanted = std::clamp(most_pixels / (block_pixels * size.width), 3, std::max(all, 3));
  std::vector<PictureRows> rows;
  for (int i = 0; i < std::min(wanted, all); ++i) {
    const int first = block_pixels * ((2 * i + 1) * all / (2 * std::min(wanted, all)));
    rows.push_back({first, std::min(block_pixels, size.height - first)});
  }
  return rows;
}

}  // namespace

Forecast forecast_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                       const RaytraceOptions& options) {
  const double pixels = static_cast<double>(options.size.pixels());
  const double chosen = std::clamp(most_rays / rays_of_a_pixel(tracer, plan, options), 16.0, grid_pixels);
  const double step = std::max(1.0, std::sqrt(pixels / chosen));
  RaytraceOptions small = options;
  small.records = false, small.picture = true, small.runs = 1;
  small.size = {coarse(options.size.width, step), coarse(options.size.height, step)};
  std::vector<std::uint32_t> lights(tracer.world().scene->lights.size());
  std::iota(lights.begin(), lights.end(), 0U);
  Forecast forecast{.rays = trace_frame(tracer, plan, camera, lights, small).rays,
                    .grid = small.size,
                    .exact = small.size == options.size};
  const double scale = pixels / static_cast<double>(small.size.pixels());
  RayCounts& rays = forecast.rays;
  for (std::uint64_t* count :
       {&rays.primary, &rays.shadow, &rays.soft_shadow, &rays.soft_shadow_asked, &rays.reflection,
        &rays.refraction, &rays.glossy, &rays.indirect, &rays.antialiasing})
    *count = static_cast<std::uint64_t>(std::llround(scale * static_cast<double>(*count)));
  return forecast;
}

SingleRayForecasts forecast_single_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                                        std::span<const std::uint32_t> lights,
                                        const RaytraceOptions& options) {
  RaytraceOptions centres = options;
  centres.picture = centres.warm_up = false;
  centres.records = true, centres.runs = centres.shadow_samples = centres.samples_per_pixel = 1;
  SingleRayForecasts forecast;
  for (const std::uint32_t light : lights) forecast.lights.push_back({.light = light});
  for (const PictureRows& rows : sampled_rows(options.size)) {
    const RayTracedFrame band = trace_band(tracer, plan, camera, lights, centres, rows);
    forecast.rows += rows.count;
    for (std::size_t i = 0; i < lights.size(); ++i)
      forecast.lights[i].rays += band.lights[i].rays, forecast.lights[i].single += band.lights[i].single_rays;
  }
  return forecast;
}

}  // namespace gnomon::raytrace
