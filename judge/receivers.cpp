#include "judge/receivers.h"

#include "judge/far_triangles.h"
#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/picture.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using raytrace::PointVisibility;
using raytrace::SurfacePoint;

/// How far from the scene's surface a capture's place may lie: pixels across the sight line, and shares of
/// the scene's diagonal, for surfaces that were cut into other triangles.
constexpr double reach_pixels = 2.0, reach_of_scene = 5e-3;

struct Retracer {
  const raytrace::Tracer& tracer;
  const Sight& sight;
  const CapturedPictures& pictures;
  const raytrace::RaytraceOptions& options;
  raytrace::RayTracedFrame& frame;
  double scene_reach;

  void receiver_at(int x, int y) const {
    const Ray ray = sight_ray(sight, pictures, x, y);
    const auto hit = tracer.closest_seen(ray);
    frame.receiver.at(x, y) = hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
  }

  /// The capture shows another place than the scene has on that sight line.
  bool is_elsewhere(int x, int y) const {
    const SurfacePoint& point = frame.receiver.at(x, y);
    const auto place = captured_place(sight, pictures, x, y);
    if (!place || point.primitive == no_id) return false;
    const View& view = sight.view;
    const Vec3 direction = view.orthographic() ? view.forward : glm::normalize(point.position - view.eye);
    const double distance = view.distance(*place), footprint = pixel_footprint(view, distance);
    const double facing = std::max(0.05, std::abs(glm::dot(point.normal, direction)));
    const double reach = std::max(reach_pixels * footprint / facing, scene_reach);
    return std::abs(view.distance(point.position) - distance) > reach;
  }

  void truth_at(std::size_t i) const {
    raytrace::LightTruth& truth = frame.lights.front();
    const Light& light = tracer.world().scene->lights[truth.light];
    const SurfacePoint& point = frame.receiver.data[i];
    const bool surface = point.primitive != no_id;
    const bool reached = surface && !light_cannot_reach(light, point.position, point.normal);
    truth.centre.data[i] = !surface  ? PointVisibility::lit
                           : reached ? tracer.centre_visibility(point, light)
                                     : PointVisibility::shadowed;
    if (!truth.is_soft()) return;
    const auto seen = reached ? raytrace::light_visibility(tracer, point, light, truth.samples,
                                                           raytrace::pixel_key(options.seed, i, truth.light))
                              : raytrace::SampledVisibility{surface ? 0.0 : 1.0, 0.0, 0};
    truth.visibility.data[i] = static_cast<float>(seen.share);
    truth.standard_error.data[i] = static_cast<float>(seen.standard_error);
  }
};

}  // namespace

std::optional<Vec3> captured_place(const Sight& sight, const CapturedPictures& pictures, int x, int y) {
  if (!pictures.position.data.empty()) {
    const Vec3& place = pictures.position.at(x, y);
    if (pictures.drawn.at(x, y) != 0) return place;
    return std::nullopt;
  }
  if (pictures.depth.data.empty() || !(pictures.depth.at(x, y) > 0.0)) return std::nullopt;
  const Ray ray = pixel_ray(sight.view, x + 0.5 + sight.shift.x, y + 0.5 + sight.shift.y);
  const double along = pictures.depth_is_distance ? 1.0 : glm::dot(ray.direction, sight.view.forward);
  return ray.at(pictures.depth.at(x, y) / along);
}

Ray sight_ray(const Sight& sight, const CapturedPictures& pictures, int x, int y) {
  if (!pictures.position.data.empty() && pictures.drawn.at(x, y) != 0)
    return ray_to(sight.view, pictures.position.at(x, y));
  return pixel_ray(sight.view, x + 0.5 + sight.shift.x, y + 0.5 + sight.shift.y);
}

Retraced retrace(const raytrace::Tracer& tracer, const Sight& sight, const CapturedPictures& pictures,
                 bool everywhere, const raytrace::RaytraceOptions& options, raytrace::RayTracedFrame& frame) {
  const TimedStage stage("capture's places");
  const World& world = tracer.world();
  constexpr double unseen = 10.0;  // times what is seen: beyond that a triangle reaches absurdly far
  const double all = world.finite_bounds.empty() ? 0.0 : world.finite_bounds.diagonal();
  const double scene = std::min(all, unseen * seen_diagonal(frame));
  const Retracer retracer{tracer, sight, pictures, options, frame, reach_of_scene * scene};
  const ImageSize size = sight.view.size;
  Retraced out{Image<std::uint8_t>(size, 0)};
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      const std::size_t i = frame.receiver.index(x, y);
      const bool placed = !pictures.position.data.empty() && pictures.drawn.data[i] != 0;
      if (everywhere || placed) {
        retracer.receiver_at(x, y);
        retracer.truth_at(i);
      }
      out.elsewhere.data[i] = retracer.is_elsewhere(x, y);
    }
  });
  return out;
}

}  // namespace gnomon::judge
