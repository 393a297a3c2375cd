#include "raytrace/shading/light_samples.h"
#include "scene/light.h"
#include "tracer_bench.h"

namespace gnomon::bench {
namespace {

/// share(point, key)
template <class Share>
double mean(const std::vector<raytrace::SurfacePoint>& points, const Share& share) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) sum += share(points[i], i);
  return sum / static_cast<double>(points.size());
}

}  // namespace

BallLight::BallLight(const raytrace::Tracer& tracer, const raytrace::RayTracedFrame& frame,
                     const Light& point)
    : tracer_(tracer), light_(point) {
  constexpr int step = 4;
  light_.extent = SphereLight{0.05 * tracer.world().finite_bounds.diagonal()};
  for (int y = 0; y < frame.receiver.size.height; y += step)
    for (int x = 0; x < frame.receiver.size.width; x += step) {
      const raytrace::SurfacePoint& p = frame.receiver.at(x, y);
      if (p.primitive != no_id && !light_cannot_reach(light_, p.position, p.normal)) points_.push_back(p);
    }
}

double BallLight::share_by_shaft() const {
  return mean(points_, [&](const raytrace::SurfacePoint& p, std::uint64_t key) {
    return light_visibility(tracer_, p, light_, samples, key).share;
  });
}

double BallLight::share_by_every_ray() const {
  return mean(points_, [&](const raytrace::SurfacePoint& p, std::uint64_t key) {
    const raytrace::LightSamples rays(tracer_, p, light_, samples, key);
    int lit = 0;
    for (int i = 0; i < samples; ++i)
      if (const std::optional<Ray> ray = rays[i]) lit += tracer_.occluded(*ray) ? 0 : 1;
    return static_cast<double>(lit) / samples;
  });
}

}  // namespace gnomon::bench
