#include "raytrace/shading/picture.h"

#include <algorithm>
#include <limits>
#include <map>

#include "raytrace/shading/light_shaft.h"
#include "raytrace/shading/picture_kernels.h"
#include "raytrace/shapes/inside.h"

namespace gnomon::raytrace {
namespace {

using PictureKernel = void (*)(const PictureInput&, RayTracedFrame&);

template <Secondary secondary>
PictureKernel kernel_of(const RaytraceOptions& options) {
  using Kind = PathKind<secondary>;
  return options.samples_per_pixel > 1 ? shade_samples<Kind> : shade_centres<Kind>;
}

PictureKernel kernel_for(const EffectPlan& plan, const RaytraceOptions& options) {
  if (plan.simulates(Effect::refraction) || plan.simulates(Effect::absorption))
    return kernel_of<Secondary::glass>(options);
  if (plan.simulates(Effect::reflection)) return kernel_of<Secondary::mirror>(options);
  return kernel_of<Secondary::none>(options);
}

/// Rays from a point to a light with size, of all lights the most.
int most_samples(const Scene& scene, const RaytraceOptions& options) {
  int most = 0;
  for (const Light& light : scene.lights)
    if (has_size(light)) most = std::max(most, samples_of(light, options));
  return most;
}

}  // namespace

std::vector<std::size_t> truth_of_light(const Scene& scene, const RayTracedFrame& frame) {
  std::vector<std::size_t> index(scene.lights.size(), std::numeric_limits<std::size_t>::max());
  for (std::size_t i = 0; i < frame.lights.size(); ++i) index[frame.lights[i].light] = i;
  return index;
}

void add_counts(const std::vector<TileCounts>& tiles, RayTracedFrame& frame) {
  for (const TileCounts& tile : tiles) frame.rays += tile.rays, frame.non_finite += tile.non_finite;
}

namespace {

bool is_body(const Material& material) {
  return material.transmission > 0.0f && !material.thin;
}

struct Body {
  std::uint32_t object, material;
};

/// Bodies of glass whose surfaces a ray from the place crosses an odd number of times, in the order of their
/// first surfaces.
std::vector<Body> bodies_ahead(const Tracer& tracer, const Vec3& place, std::uint64_t& rays) {
  constexpr int most_surfaces = 4096;  // beyond them the place counts as outside
  const World& world = tracer.world();
  std::vector<Body> order;
  std::map<std::uint32_t, bool> odd;  // by object
  Ray ray{place, glm::normalize(Vec3(0.3178, 0.8367, 0.4461))};
  for (int surface = 0; surface < most_surfaces; ++surface) {
    ++rays;
    const std::optional<Hit> hit = tracer.closest_hit(ray);
    if (!hit) {
      std::erase_if(order, [&](const Body& body) { return !odd[body.object]; });
      return order;
    }
    const std::uint32_t material = world.material_of(hit->primitive);
    if (is_body(world.scene->materials[material])) {
      const std::uint32_t object = world.object_of(hit->primitive);
      const auto [entry, first] = odd.emplace(object, false);
      if (first) order.push_back({object, material});
      entry->second = !entry->second;
    }
    ray = tracer.spawn_ray(tracer.surface_point(ray, *hit), ray.direction);
  }
  return {};
}

}  // namespace

Interior interior_at(const Tracer& tracer, const Vec3& place, std::uint64_t& rays) {
  const std::vector<Body> ahead = bodies_ahead(tracer, place, rays);
  Interior interior;
  if (ahead.empty()) return interior;
  const InsideTest test(tracer.world());                          // says no to what is not closed
  for (auto body = ahead.rbegin(); body != ahead.rend(); ++body)  // what is left last was entered first
    if (test.contains(body->object, place)) interior.enter(body->material);
  return interior;
}

void shade_picture(const Tracer& tracer, const EffectPlan& plan, const View& view, int first_row,
                   const RaytraceOptions& options, const UnstoredReceivers* unstored, RayTracedFrame& frame) {
  PictureInput input{.tracer = tracer,
                     .view = view,
                     .options = options,
                     .effects = ShadedEffects(plan),
                     .unstored = unstored,
                     .first_row = first_row};
  // The rays of an orthographic camera start outside all glass.
  if (plan.simulates(Effect::refraction) && !view.orthographic())
    input.eye = interior_at(tracer, view.eye, frame.rays.interior);
  if (plan.simulates(Effect::soft_shadow))
    prepare_light_shafts(tracer, most_samples(*tracer.world().scene, options));
  kernel_for(plan, options)(input, frame);
}

}  // namespace gnomon::raytrace
