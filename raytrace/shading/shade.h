// Whitted's recursion (Whitted 1980): local shading, the mirror's ray, and behind glass Fresnel's split into a
// reflected and a refracted ray; rough surfaces and indirect light by samples. Compiled for what changes a path (no
// secondary rays, mirrors, glass); the other effects are asked of the plan, in branches that cost nothing beside rays.
//
// Conventions. The geometric normal decides what a surface is turned towards (light, viewer, entering or leaving); the
// interpolated one, turned to the viewer's side, shades, reflects and refracts. Closed surfaces of glass are solid: a
// ray against the outward normal enters; what is there where bodies nest or overlap is said by
// raytrace/shading/interior.h. A shadow ray goes straight through glass: each boundary lets transmission * (1 -
// Fresnel) pass, as seen from its thinner side, and the media between absorb. Rays beyond Scene::max_depth or below
// the contribution cut-off bring nothing. Paths that share a pixel share its samples: where n of them run side by
// side, each takes 1/n of the samples that are asked for, at least one.
#pragma once

#include <type_traits>

#include "raytrace/frame.h"
#include "raytrace/shading/fresnel.h"
#include "raytrace/shading/interior.h"
#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/light_shaft.h"
#include "raytrace/shading/microfacet.h"
#include "raytrace/shading/path_kind.h"
#include "raytrace/shading/smooth_surface.h"
#include "raytrace/shapes/mask_cells.h"
#include "scene/light.h"

namespace gnomon::raytrace {

// Local shading, the same arithmetic as the rasterizer's GLSL (Blinn 1977). No pi factors: irradiance 1 on a
// surface facing the light with diffuse 1 gives radiance 1. Whether the light reaches the surface at all is
// light_cannot_reach's decision.

/// normal: unit shading normal on the viewer's side; to_viewer: unit. The result does not include the shadow.
inline Vec3f blinn_phong(const LightAtPoint& light, const Vec3& normal, const Vec3& to_viewer,
                         const Vec3f& diffuse, const Material& material, bool specular) {
  const double n_dot_l = glm::dot(normal, light.to_light);
  if (!(n_dot_l > 0.0)) return Vec3f(0.0f);
  Vec3f radiance = diffuse * static_cast<float>(n_dot_l);
  if (specular) {
    const Vec3 half_way = light.to_light + to_viewer;
    const double length = glm::length(half_way);
    const double n_dot_h = length > 0.0 ? std::max(0.0, glm::dot(normal, half_way) / length) : 0.0;
    radiance +=
        material.specular * static_cast<float>(std::pow(n_dot_h, static_cast<double>(material.shininess)));
  }
  return radiance * light.irradiance;
}

template <class Kind>
class Shader {
 public:
  using Path = PathOf<Kind>;

  /// One for each pixel: its number and options.seed choose the samples.
  Shader(const PictureInput& input, std::size_t pixel, RayCounts& counts)
      : tracer_(input.tracer),
        world_(tracer_.world()),
        scene_(*world_.scene),
        options_(input.options),
        on_(input.effects),
        pixel_key_(sample_key(options_.seed, pixel)),
        counts_(counts) {}

  /// For the next set of samples.
  std::uint64_t next_key() { return sample_key(pixel_key_, ~++points_sampled_); }

  /// Radiance from a point towards where the path came from. shadow(light index) in [0, 1] is asked only for
  /// lights that can reach the point.
  template <class Shadow>
  [[gnu::noinline]] Vec3f leaving(const SurfacePoint& point, const Path& path, const Shadow& shadow) {
    const Material& material = scene_.materials[world_.material_of(point.primitive)];
    const Vec3 normal = shading_normal(world_, point);
    const float local_share =
        Kind::reflects ? std::max(0.0f, 1.0f - material.mirror - material.transmission) : 1.0f;
    Vec3f radiance = emitted(point, material);
    if (local_share > 0.0f) radiance += local_share * local(point, path, material, normal, shadow);
    if constexpr (Kind::reflects) radiance += secondary(point, path, material, normal);
    return radiance;
  }

  /// Radiance along a path that intersects the `first` point after `length`, through what is no boundary of its
  /// medium. `count` counts the rays that go on behind that.
  Vec3f arriving(const SurfacePoint& first, double length, Path path, std::uint64_t& count) {
    SurfacePoint point = first;
    if constexpr (Kind::refracts) {
      for (int passed = 0; !is_boundary(point, path.inside); ++passed) {
        if (passed == max_glass_surfaces) return Vec3f(0.0f);
        ++count;
        const Ray ray = tracer_.spawn_ray(point, path.direction);
        const std::optional<Hit> hit = tracer_.closest_seen(ray);
        if (!hit) return scene_.background;
        length += hit->t;
        point = tracer_.surface_point(ray, *hit);
      }
    }
    const auto shadow = [&](std::uint32_t i) { return transmittance(point, path, i); };
    Vec3f radiance = leaving(point, path, shadow);
    if constexpr (Kind::refracts)
      if (on_.absorbs) radiance *= absorbed(path.inside.medium(scene_), length);
    return radiance;
  }

  /// Share of the light that arrives along straight lines.
  Vec3f transmittance(const SurfacePoint& point, const Path& path, std::uint32_t light_index) {
    const Light& light = scene_.lights[light_index];
    if (!tracer_.receives_shadow(point)) return Vec3f(1.0f);
    if (on_.soft && has_size(light)) return soft_transmittance(point, path, light, light_index);
    if constexpr (Kind::refracts)
      return through_glass(tracer_.shadow_ray(point, light), path.inside, counts_.shadow);
    ++counts_.shadow;
    return Vec3f(is_blocked(point, light) ? 0.0f : 1.0f);
  }

 private:
  static constexpr int max_glass_surfaces = 64;  // on one straight line; what is behind more of them is dark

  /// `exact` certifies the answer for a light's centre; a sample of its size is taken to be exactly what its doubles say.
  bool is_blocked(const SurfacePoint& point, const Light& light) const {
    if (tracer_.precision() == Precision::exact)
      return tracer_.centre_visibility(point, light) != PointVisibility::lit;
    return tracer_.occluded(tracer_.shadow_ray(point, light));
  }

  /// What a path takes of `wanted` samples.
  static int shared(int wanted, const Path& path) { return (wanted + path.siblings - 1) / path.siblings; }

  static bool is_in_vacuum(const Path& path) {
    if constexpr (Kind::refracts) return path.inside.empty();
    return true;
  }

  /// The mean over the light's samples; each point of the pixel's paths has its own.
  Vec3f soft_transmittance(const SurfacePoint& point, const Path& path, const Light& light,
                           std::uint32_t light_index) {
    const int count = shared(samples_of(light, options_), path);
    const std::uint64_t key = sample_key(sample_key(pixel_key_, light_index), ++points_sampled_);
    counts_.soft_shadow_asked += static_cast<std::uint64_t>(count);
    const auto blockers = find_light_blockers(tracer_, point, light, is_in_vacuum(path) ? count : 0);
    if (blockers.none()) return Vec3f(1.0f);
    const LightSamples samples(tracer_, point, light, count, key);
    Vec3f sum(0.0f);
    for (int i = 0; i < count; ++i) {
      const std::optional<Ray> ray = samples[i];
      if (!ray) continue;
      if constexpr (Kind::refracts) {
        sum += through_glass(*ray, path.inside, counts_.soft_shadow);
      } else {
        ++counts_.soft_shadow;
        sum += Vec3f(blockers.block(tracer_, *ray) ? 0.0f : 1.0f);
      }
    }
    return sum / static_cast<float>(count);
  }

  Vec3f texture_at(const SurfacePoint& point, std::uint32_t texture,
                   const TextureTransform& transform) const {
    const Vec2 uv = surface_uv(world_, point.primitive, point.barycentric, point.position);
    return Vec3f(sample_texture(scene_.textures[texture], transform_uv(transform, uv)));
  }

  Vec3f emitted(const SurfacePoint& point, const Material& material) const {
    if (!on_.textures || material.emission_texture == no_id) return material.emission;
    return material.emission * texture_at(point, material.emission_texture, material.emission_transform);
  }

  template <class Shadow>
  Vec3f local(const SurfacePoint& point, const Path& path, const Material& material, const Vec3& normal,
              const Shadow& shadow) {
    Vec3f diffuse = material.diffuse;
    if (on_.textures && material.diffuse_texture != no_id)
      diffuse *= texture_at(point, material.diffuse_texture, material.texture_transform);
    if (on_.vertex_colors) diffuse *= Vec3f(surface_color(world_, point.primitive, point.barycentric));
    if (material.unlit) return diffuse;
    Vec3f radiance = scene_.ambient * diffuse;
    if (options_.terminator_offset) {
      const SurfacePoint body = on_smooth_body(world_, point);
      add_lights(body, path, material, normal, diffuse, radiance,
                 [&](std::uint32_t i) { return transmittance(body, path, i); });
    } else {
      add_lights(point, path, material, normal, diffuse, radiance, shadow);
    }
    if (on_.indirect && !path.gathers && diffuse != Vec3f(0.0f))
      radiance += diffuse * gathered(point, path, normal);
    return radiance;
  }

  template <class Shadow>
  void add_lights(const SurfacePoint& point, const Path& path, const Material& material, const Vec3& normal,
                  const Vec3f& diffuse, Vec3f& radiance, const Shadow& shadow) {
    for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
      const Light& light = scene_.lights[i];
      if (light_cannot_reach(light, point.position, point.normal)) continue;
      const Vec3f unshadowed = blinn_phong(light_at(light, point.position), normal, -path.direction, diffuse,
                                           material, on_.specular);
      if (unshadowed != Vec3f(0.0f)) radiance += unshadowed * shadow(i);
    }
  }

  /// The mean radiance over the hemisphere, weighted by the cosine: with no pi factors (blinn_phong.h), what
  /// a white surface shows of it. Nothing comes from below the geometric horizon.
  Vec3f gathered(const SurfacePoint& point, const Path& path, const Vec3& normal) {
    const int count = shared(scene_.indirect_samples, path);
    const StratifiedSquare square(static_cast<std::uint32_t>(count), next_key());
    Vec3f sum(0.0f);
    for (int i = 0; i < count; ++i) {
      Path next = path;
      next.direction = cosine_direction(normal, square[static_cast<std::uint32_t>(i)]);
      if (!(glm::dot(next.direction, point.normal) > 0.0)) continue;
      next.depth = path.depth + 1, next.siblings = path.siblings * count, next.gathers = true;
      if (next.depth <= scene_.max_depth) sum += along(point, next, counts_.indirect);
    }
    return sum / static_cast<float>(count);
  }

  Vec3f secondary(const SurfacePoint& point, const Path& path, const Material& material,
                  const Vec3& shading) {
    if (material.mirror <= 0.0f && material.transmission <= 0.0f) return Vec3f(0.0f);
    // A shading normal turned away from the ray cannot guide it.
    const Vec3 normal = glm::dot(shading, path.direction) < 0.0 ? shading : point.normal;
    if (on_.glossy && material.roughness > 0.0f) return rough(point, path, material, normal);
    return scattered(point, path, material, normal, normal, Smooth{}, counts_.reflection, counts_.refraction);
  }

  struct Smooth {
    static double visible_share(const Vec3&) { return 1.0; }
  };

  Vec3f rough(const SurfacePoint& point, const Path& path, const Material& material, const Vec3& normal) {
    const int count = shared(scene_.glossy_samples, path);
    const Microfacets facets(normal, -path.direction, static_cast<double>(material.roughness));
    const StratifiedSquare square(static_cast<std::uint32_t>(count), next_key());
    Path sample = path;
    sample.siblings *= count;
    Vec3f sum(0.0f);
    for (int i = 0; i < count; ++i)
      sum += scattered(point, sample, material, normal, facets.normal(square[static_cast<std::uint32_t>(i)]),
                       facets, counts_.glossy, counts_.glossy);
    return sum / static_cast<float>(count);
  }

  /// What one facet reflects and refracts.
  template <class Facets>
  Vec3f scattered(const SurfacePoint& point, const Path& path, const Material& material, const Vec3& normal,
                  const Vec3& facet, const Facets& facets, std::uint64_t& reflections,
                  std::uint64_t& refractions) {
    Vec3f radiance(0.0f);
    double reflected = material.mirror;
    if constexpr (Kind::refracts) {
      if (material.transmission > 0.0f) {
        const double transmission = static_cast<double>(material.transmission);
        Path next = path;
        const Refraction refraction = through(point, path, material, normal, facet, next);
        reflected += transmission * refraction.reflectance;
        const double share =
            transmission * (1.0 - refraction.reflectance) * facets.visible_share(refraction.direction);
        const bool leaves = glm::dot(refraction.direction, point.normal) < 0.0 &&
                            glm::dot(refraction.direction, normal) < 0.0;
        if (share > 0.0 && leaves) radiance += follow(point, next, refraction.direction, share, refractions);
      }
    }
    if (!(reflected > 0.0)) return radiance;
    Vec3 direction = reflect(path.direction, facet);
    if constexpr (!std::is_same_v<Facets, Smooth>)
      if (!(glm::dot(direction, normal) > 0.0)) return radiance;  // hidden by the next facet
    const double share = reflected * facets.visible_share(direction);
    if (!(glm::dot(direction, point.normal) > 0.0)) direction = reflect(path.direction, point.normal);
    return radiance + follow(point, path, glm::normalize(direction), share, reflections);
  }

  /// The refracted ray, and what it is inside of. A thin sheet has no inside: what a facet would reflect goes
  /// on behind it instead.
  Refraction through(const SurfacePoint& point, const Path& path, const Material& material,
                     const Vec3& normal, const Vec3& facet, Path& next) const {
    if (material.thin) {
      const Vec3 mirrored = reflect(path.direction, facet);
      return {0.0, mirrored - 2.0 * glm::dot(mirrored, normal) * normal};
    }
    const Crossing crossing =
        cross(scene_, path.inside, world_.material_of(point.primitive), is_entering(point));
    next.inside = crossing.inside;
    return refract(path.direction, facet,
                   index_of(scene_, crossing.before) / index_of(scene_, crossing.behind));
  }

  Vec3f follow(const SurfacePoint& from, Path next, const Vec3& direction, double share,
               std::uint64_t& count) {
    next.direction = direction, next.weight *= share, ++next.depth;
    if (next.depth > scene_.max_depth || next.weight < options_.min_contribution) return Vec3f(0.0f);
    return static_cast<float>(share) * along(from, next, count);
  }

  Vec3f along(const SurfacePoint& from, const Path& path, std::uint64_t& count) {
    ++count;
    const Ray ray = tracer_.spawn_ray(from, path.direction);
    const std::optional<Hit> hit = tracer_.closest_seen(ray);
    if (!hit) return scene_.background;
    return arriving(tracer_.surface_point(ray, *hit), hit->t, path, count);
  }

  bool is_entering(const SurfacePoint& point) const {
    return glm::dot(outward_normal(world_, point.primitive, point.position), point.normal) > 0.0;
  }

  /// False for glass behind which the medium is the same; then `inside` is what is there.
  bool is_boundary(const SurfacePoint& point, Interior& inside) const {
    const std::uint32_t id = world_.material_of(point.primitive);
    const Material& material = scene_.materials[id];
    if (material.transmission <= 0.0f || material.thin) return true;
    const Crossing crossing = cross(scene_, inside, id, is_entering(point));
    if (!crossing.is_boundary()) inside = crossing.inside;
    return crossing.is_boundary();
  }

  /// Beer-Lambert: exp(-absorption * length).
  Vec3f absorbed(std::uint32_t medium, double length) const {
    if (medium == no_id) return Vec3f(1.0f);
    return glm::exp(-scene_.materials[medium].absorption * static_cast<float>(length));
  }

  /// `count` counts this ray and those that go on behind glass.
  Vec3f through_glass(Ray ray, Interior inside, std::uint64_t& count) const {
    Vec3f share(1.0f);
    for (int surfaces = 0; surfaces < max_glass_surfaces; ++surfaces) {
      ++count;
      const std::optional<Hit> hit = tracer_.closest_hit(ray, Sides::casting);
      if (!hit) return share * to_the_light(ray, inside);
      const std::uint32_t id = world_.material_of(hit->primitive);
      const Material& material = scene_.materials[id];
      if (material.transmission <= 0.0f) return Vec3f(0.0f);
      const SurfacePoint point = tracer_.surface_point(ray, *hit);
      if (material.thin) {
        share *= material.transmission;
      } else {
        const Crossing crossing = cross(scene_, inside, id, is_entering(point));
        if (on_.absorbs) share *= absorbed(crossing.before, hit->t);
        if (crossing.is_boundary()) share *= material.transmission * passing(crossing, ray, point);
        inside = crossing.inside;
      }
      if (share == Vec3f(0.0f)) return share;
      const double end = ray.t.max - hit->t;
      ray = tracer_.spawn_ray(point, ray.direction);
      ray.t.max = end;
    }
    return Vec3f(0.0f);
  }

  /// The last piece, when the light itself is in glass.
  Vec3f to_the_light(const Ray& ray, const Interior& inside) const {
    if (on_.absorbs)
      if (std::isfinite(ray.t.max)) return absorbed(inside.medium(scene_), ray.t.max);
    return Vec3f(1.0f);
  }

  /// A straight ray knows no critical angle: Fresnel's share as it is from the thinner side.
  float passing(const Crossing& crossing, const Ray& ray, const SurfacePoint& point) const {
    const double a = index_of(scene_, crossing.before), b = index_of(scene_, crossing.behind);
    const double eta = std::min(a, b) / std::max(a, b);
    return static_cast<float>(1.0 - refract(glm::normalize(ray.direction), point.normal, eta).reflectance);
  }

  const Tracer& tracer_;
  const World& world_;
  const Scene& scene_;
  const RaytraceOptions& options_;
  const ShadedEffects& on_;
  const std::uint64_t pixel_key_;
  std::uint64_t points_sampled_ = 0;  // so far
  RayCounts& counts_;
};

}  // namespace gnomon::raytrace
