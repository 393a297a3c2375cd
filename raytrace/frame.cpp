#include "raytrace/frame.h"

#include <limits>

#include "raytrace/packet/passes.h"
#include "raytrace/shade.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

/// The warm-up run, when there are several, is made and not kept.
template <class Pass>
Times time_pass(int runs, const Pass& pass) {
  Times times;
  if (runs > 1) pass();
  for (int run = 0; run < std::max(1, runs); ++run) time_run(times, pass);
  return times;
}

void trace_primary(const Tracer& tracer, const View& view, const RaytraceOptions& options,
                   RayTracedFrame& frame) {
  frame.receiver = Image<SurfacePoint>(options.size);
  frame.primary_rays = time_pass(options.runs, [&] {
    if (packets_apply(tracer.structures())) {
      const Seen eye = seen_from(tracer.structures(), view.eye, false);
      for_each_tile({options.size}, [&](std::size_t, int x0, int y0, int x1, int y1) {
        primary_tile(tracer, view, eye, {x0, y0, x1, y1}, frame.receiver);
      });
      return;
    }
    for_each_pixel({options.size}, [&](int x, int y, std::size_t) {
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const std::optional<Hit> hit = tracer.closest_hit(ray);
      frame.receiver.at(x, y) = hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
    });
  });
  frame.rays.primary = options.size.pixels();
}

bool reaches(const Light& light, const SurfacePoint& point) {
  return point.primitive != no_id && !light_cannot_reach(light, point.position, point.normal);
}

LightTruth trace_shadows(const Tracer& tracer, std::uint32_t light_index, const RaytraceOptions& options,
                         const Image<SurfacePoint>& receivers) {
  const Light& light = tracer.world().scene->lights[light_index];
  LightTruth truth{
      .light = light_index, .verdict = Image<Verdict>(options.size, Verdict::lit), .shadow_rays = {}};
  const TileGrid grid{options.size};
  std::vector<std::uint64_t> rays(grid.count());
  truth.shadow_rays = time_pass(options.runs, [&] {
    std::fill(rays.begin(), rays.end(), 0);
    if (packets_apply(tracer.structures())) {
      const Seen seen = seen_from(tracer.structures(), light);
      for_each_tile(grid, [&](std::size_t tile, int x0, int y0, int x1, int y1) {
        rays[tile] = shadow_tile(tracer, light, seen, {x0, y0, x1, y1}, receivers, truth.verdict);
      });
      return;
    }
    for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
      const SurfacePoint& point = receivers.at(x, y);
      if (point.primitive == no_id) return;
      const bool reached = reaches(light, point);
      truth.verdict.at(x, y) = reached ? tracer.light_verdict(point, light) : Verdict::shadowed;
      rays[tile] += reached ? 1 : 0;
    });
  });
  for (const std::uint64_t n : rays) truth.rays += n;
  return truth;
}

/// For each light of the scene its place in RayTracedFrame::lights, or npos.
std::vector<std::size_t> truth_of_light(const Scene& scene, const RayTracedFrame& frame) {
  std::vector<std::size_t> index(scene.lights.size(), std::numeric_limits<std::size_t>::max());
  for (std::size_t i = 0; i < frame.lights.size(); ++i) index[frame.lights[i].light] = i;
  return index;
}

template <class Policy>
void shade_picture(const Tracer& tracer, const View& view, const RaytraceOptions& options,
                   RayTracedFrame& frame) {
  const Scene& scene = *tracer.world().scene;
  const std::vector<std::size_t> truth = truth_of_light(scene, frame);
  const TileGrid grid{options.size};
  std::vector<RayCounts> counts(grid.count());
  for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
    const SurfacePoint& point = frame.receiver.at(x, y);
    if (point.primitive == no_id) {
      frame.color.at(x, y) = scene.background;
      return;
    }
    Shader<Policy> shader(tracer, options.min_contribution, counts[tile]);
    // A verdict already known saves the ray, but for light that glass may let through and for doubtful
    // pixels.
    const auto shadow = [&](std::uint32_t i) {
      if (truth[i] < frame.lights.size()) {
        const Verdict verdict = frame.lights[truth[i]].verdict.at(x, y);
        if (verdict == Verdict::lit) return Vec3f(1.0f);
        if (verdict == Verdict::shadowed && !Policy::refracts) return Vec3f(0.0f);
      }
      return shader.transmittance(point, scene.lights[i]);
    };
    frame.color.at(x, y) = shader.leaving(point, {pixel_ray(view, x + 0.5, y + 0.5).direction}, shadow);
  });
  for (const RayCounts& c : counts) {
    frame.rays.shadow += c.shadow;
    frame.rays.reflection += c.reflection;
    frame.rays.refraction += c.refraction;
  }
}

using PictureKernel = void (*)(const Tracer&, const View&, const RaytraceOptions&, RayTracedFrame&);

template <Secondary secondary>
PictureKernel choose_local(const EffectPlan& plan) {
  const bool textures = plan.simulates(Effect::textures), specular = plan.simulates(Effect::specular);
  if (textures)
    return specular ? shade_picture<ShadePolicy<secondary, true, true>>
                    : shade_picture<ShadePolicy<secondary, true, false>>;
  return specular ? shade_picture<ShadePolicy<secondary, false, true>>
                  : shade_picture<ShadePolicy<secondary, false, false>>;
}

PictureKernel choose_kernel(const EffectPlan& plan) {
  if (plan.simulates(Effect::absorption)) return choose_local<Secondary::absorbing_glass>(plan);
  if (plan.simulates(Effect::refraction)) return choose_local<Secondary::glass>(plan);
  if (plan.simulates(Effect::reflection)) return choose_local<Secondary::mirror>(plan);
  return choose_local<Secondary::none>(plan);
}

}  // namespace

Vec3 shading_normal(const World& world, const SurfacePoint& point) {
  if (!world.is_triangle(point.primitive)) return point.normal;
  const auto& t = world.triangles[point.primitive];
  const double b0 = 1.0 - point.barycentric.x - point.barycentric.y;
  const Vec3 n = b0 * Vec3(world.normals[t[0]]) + point.barycentric.x * Vec3(world.normals[t[1]]) +
                 point.barycentric.y * Vec3(world.normals[t[2]]);
  const double length = glm::length(n);
  if (!(length > 0.0)) return point.normal;
  return glm::dot(n, point.normal) < 0.0 ? -n / length : n / length;
}

RayTracedFrame trace_frame(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                           std::span<const std::uint32_t> lights, const RaytraceOptions& options) {
  const View view = make_view(camera, options.size);
  RayTracedFrame frame;
  trace_primary(tracer, view, options, frame);
  for (const std::uint32_t light : lights) {
    frame.lights.push_back(trace_shadows(tracer, light, options, frame.receiver));
    frame.rays.shadow += frame.lights.back().rays;
  }
  if (options.picture) {
    frame.color = ColorImage(options.size);
    const Stopwatch watch;
    choose_kernel(plan)(tracer, view, options, frame);
    frame.picture_ms = watch.elapsed_ms();
  }
  return frame;
}

}  // namespace gnomon::raytrace
