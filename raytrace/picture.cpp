#include "raytrace/picture.h"

#include <limits>

#include "raytrace/shade.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

/// For each light of the scene its place in RayTracedFrame::lights, or npos.
std::vector<std::size_t> truth_of_light(const Scene& scene, const RayTracedFrame& frame) {
  std::vector<std::size_t> index(scene.lights.size(), std::numeric_limits<std::size_t>::max());
  for (std::size_t i = 0; i < frame.lights.size(); ++i) index[frame.lights[i].light] = i;
  return index;
}

template <class Policy>
void shade_pixels(const Tracer& tracer, const View& view, const RaytraceOptions& options,
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
    Shader<Policy> shader(tracer, options, frame.receiver.index(x, y), counts[tile]);
    // A verdict already known saves the ray, but for light that glass may let through and for doubtful
    // pixels.
    const auto shadow = [&](std::uint32_t i) {
      if (truth[i] < frame.lights.size()) {
        if constexpr (Policy::soft) {
          const Image<float>& visibility = frame.lights[truth[i]].visibility;
          if (!visibility.data.empty())
            return Policy::refracts && visibility.at(x, y) < 1.0f ? shader.transmittance(point, i)
                                                                  : Vec3f(visibility.at(x, y));
        }
        const Verdict verdict = frame.lights[truth[i]].verdict.at(x, y);
        if (verdict == Verdict::lit) return Vec3f(1.0f);
        if (verdict == Verdict::shadowed && !Policy::refracts) return Vec3f(0.0f);
      }
      return shader.transmittance(point, i);
    };
    frame.color.at(x, y) = shader.leaving(point, {pixel_ray(view, x + 0.5, y + 0.5).direction}, shadow);
  });
  for (const RayCounts& c : counts) {
    frame.rays.shadow += c.shadow;
    frame.rays.soft_shadow += c.soft_shadow;
    frame.rays.reflection += c.reflection;
    frame.rays.refraction += c.refraction;
  }
}

using PictureKernel = void (*)(const Tracer&, const View&, const RaytraceOptions&, RayTracedFrame&);

template <Secondary secondary, bool soft>
PictureKernel choose_local(const EffectPlan& plan) {
  const bool textures = plan.simulates(Effect::textures), specular = plan.simulates(Effect::specular);
  if (textures)
    return specular ? shade_pixels<ShadePolicy<secondary, true, true, soft>>
                    : shade_pixels<ShadePolicy<secondary, true, false, soft>>;
  return specular ? shade_pixels<ShadePolicy<secondary, false, true, soft>>
                  : shade_pixels<ShadePolicy<secondary, false, false, soft>>;
}

template <bool soft>
PictureKernel choose_secondary(const EffectPlan& plan) {
  if (plan.simulates(Effect::absorption)) return choose_local<Secondary::absorbing_glass, soft>(plan);
  if (plan.simulates(Effect::refraction)) return choose_local<Secondary::glass, soft>(plan);
  if (plan.simulates(Effect::reflection)) return choose_local<Secondary::mirror, soft>(plan);
  return choose_local<Secondary::none, soft>(plan);
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

void shade_picture(const Tracer& tracer, const EffectPlan& plan, const View& view,
                   const RaytraceOptions& options, RayTracedFrame& frame) {
  const PictureKernel kernel =
      plan.simulates(Effect::soft_shadow) ? choose_secondary<true>(plan) : choose_secondary<false>(plan);
  kernel(tracer, view, options, frame);
}

}  // namespace gnomon::raytrace
