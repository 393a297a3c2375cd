#include "raytrace/forecast.h"

#include <numeric>

namespace gnomon::raytrace {
namespace {

constexpr double grid_pixels = 8192.0;

int coarse(int side, double step) {
  return std::max(1, static_cast<int>(std::lround(side / step)));
}

}  // namespace

Forecast forecast_rays(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                       const RaytraceOptions& options) {
  const double pixels = static_cast<double>(options.size.pixels());
  const double step = std::max(1.0, std::sqrt(pixels / grid_pixels));
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
