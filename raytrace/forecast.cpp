#include "raytrace/forecast.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/light.h"

namespace gnomon::raytrace {
namespace {

constexpr double grid_pixels = 8192.0;
/// As many rays as they may cost; with more samples there are fewer pixels.
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

}  // namespace gnomon::raytrace
