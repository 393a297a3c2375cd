// Whitted's recursion (Whitted 1980): local shading, the mirror's ray, and behind glass Fresnel's split into
// a reflected and a refracted ray. Specialised by what the scene calls for: an effect that is not called for
// has no code here.
//
// Conventions. The geometric normal decides what a surface is turned towards (light, viewer, entering or
// leaving); the interpolated one, turned to the viewer's side, shades, reflects and refracts. Closed surfaces
// are taken to be solid: a ray against the outward normal enters. One medium is known at a time, the one last
// entered; leaving leads to the vacuum. A shadow ray goes straight through glass: each surface lets
// transmission * (1 - Fresnel) pass, as the face of a slab does, and the medium between absorbs. Rays beyond
// Scene::max_depth or below the contribution cut-off bring nothing.
#pragma once

#include "raytrace/blinn_phong.h"
#include "raytrace/frame.h"
#include "raytrace/fresnel.h"
#include "raytrace/light_samples.h"
#include "raytrace/surface_uv.h"

namespace gnomon::raytrace {

enum class Secondary : std::uint8_t { none, mirror, glass, absorbing_glass };

template <Secondary secondary_, bool textures_, bool specular_, bool soft_>
struct ShadePolicy {
  static constexpr bool reflects = secondary_ != Secondary::none;
  static constexpr bool refracts = secondary_ == Secondary::glass || secondary_ == Secondary::absorbing_glass;
  static constexpr bool absorbs = secondary_ == Secondary::absorbing_glass;
  static constexpr bool textures = textures_;
  static constexpr bool specular = specular_;
  static constexpr bool soft = soft_;  ///< some light has a size
};

/// Interpolated and normalised, on the side of the point's geometric normal; the geometric normal where the
/// mesh has none.
Vec3 shading_normal(const World& world, const SurfacePoint& point);

/// What a ray has met on its way into the recursion.
struct Path {
  Vec3 direction;                ///< unit
  int depth = 0;                 ///< 0: from the eye
  double weight = 1.0;           ///< share of the pixel
  std::uint32_t medium = no_id;  ///< material of the glass that the ray runs in
};

template <class Policy>
class Shader {
 public:
  /// One for each pixel: its number and options.seed choose the samples.
  Shader(const Tracer& tracer, const RaytraceOptions& options, std::size_t pixel, RayCounts& counts)
      : tracer_(tracer),
        world_(tracer.world()),
        scene_(*world_.scene),
        options_(options),
        pixel_key_(sample_key(options.seed, pixel)),
        counts_(counts) {}

  /// Radiance from a point towards where the path came from. shadow(light index) in [0, 1] is asked only for
  /// lights that can reach the point.
  template <class Shadow>
  Vec3f leaving(const SurfacePoint& point, const Path& path, const Shadow& shadow) {
    const Material& material = scene_.materials[world_.material_of(point.primitive)];
    const Vec3 normal = shading_normal(world_, point);
    const float local_share =
        Policy::reflects ? std::max(0.0f, 1.0f - material.mirror - material.transmission) : 1.0f;
    Vec3f radiance = material.emission;
    if (local_share > 0.0f) radiance += local_share * local(point, path, material, normal, shadow);
    if constexpr (Policy::reflects) radiance += secondary(point, path, material, normal);
    return radiance;
  }

  /// Share of the light that arrives along straight lines.
  Vec3f transmittance(const SurfacePoint& point, std::uint32_t light_index) {
    const Light& light = scene_.lights[light_index];
    if constexpr (Policy::soft)
      if (has_size(light)) return soft_transmittance(point, light, light_index);
    ++counts_.shadow;
    if constexpr (!Policy::refracts)
      return Vec3f(is_blocked(point, light) ? 0.0f : 1.0f);
    else
      return transmittance(tracer_.shadow_ray(point, light));
  }

 private:
  static constexpr int max_glass_surfaces = 64;  // on one shadow ray; what is behind more of them is dark

  /// `exact` certifies the ray to the light's centre; samples of a light's size are decided as `robust` does.
  bool is_blocked(const SurfacePoint& point, const Light& light) const {
    if (tracer_.precision() == Precision::exact) return tracer_.light_verdict(point, light) != Verdict::lit;
    return tracer_.occluded(tracer_.shadow_ray(point, light));
  }

  Vec3f transmittance(const Ray& ray) {
    if constexpr (!Policy::refracts)
      return Vec3f(tracer_.occluded(ray) ? 0.0f : 1.0f);
    else
      return through_glass(ray);
  }

  /// The mean over the light's samples; each point of the pixel's paths has its own.
  Vec3f soft_transmittance(const SurfacePoint& point, const Light& light, std::uint32_t light_index) {
    const int count = options_.shadow_samples > 0 ? options_.shadow_samples : light.shadow_samples;
    const std::uint64_t key = sample_key(sample_key(pixel_key_, light_index), ++points_lit_);
    const LightSamples samples(tracer_, point, light, count, key);
    Vec3f sum(0.0f);
    for (int i = 0; i < count; ++i) {
      const std::optional<Ray> ray = samples[i];
      if (!ray) continue;
      ++counts_.soft_shadow;
      sum += transmittance(*ray);
    }
    return sum / static_cast<float>(count);
  }

  template <class Shadow>
  Vec3f local(const SurfacePoint& point, const Path& path, const Material& material, const Vec3& normal,
              const Shadow& shadow) {
    Vec3f diffuse = material.diffuse;
    if constexpr (Policy::textures) {
      if (material.diffuse_texture != no_id) {
        const Vec2 uv = surface_uv(world_, point.primitive, point.barycentric, point.position);
        diffuse *= Vec3f(sample_texture(scene_.textures[material.diffuse_texture],
                                        transform_uv(material.texture_transform, uv)));
      }
    }
    Vec3f radiance = scene_.ambient * diffuse;
    for (std::uint32_t i = 0; i < scene_.lights.size(); ++i) {
      const Light& light = scene_.lights[i];
      if (light_cannot_reach(light, point.position, point.normal)) continue;
      const Vec3f unshadowed = blinn_phong<Policy::specular>(light_at(light, point.position), normal,
                                                             -path.direction, diffuse, material);
      if (unshadowed != Vec3f(0.0f)) radiance += unshadowed * shadow(i);
    }
    return radiance;
  }

  Vec3f secondary(const SurfacePoint& point, const Path& path, const Material& material,
                  const Vec3& shading) {
    double reflected = material.mirror;
    if (reflected <= 0.0 && material.transmission <= 0.0f) return Vec3f(0.0f);
    // A shading normal turned away from the ray cannot guide it.
    const Vec3 normal = glm::dot(shading, path.direction) < 0.0 ? shading : point.normal;
    Vec3f radiance(0.0f);
    if constexpr (Policy::refracts) {
      if (material.transmission > 0.0f) {
        const bool entering =
            glm::dot(geometric_normal(world_, point.primitive, point.position), point.normal) > 0.0;
        const double ior = static_cast<double>(material.ior);
        const Refraction refraction = refract(path.direction, normal, entering ? 1.0 / ior : ior);
        const double transmission = static_cast<double>(material.transmission);
        reflected += transmission * refraction.reflectance;
        const double refracted = transmission * (1.0 - refraction.reflectance);
        const std::uint32_t medium = entering ? world_.material_of(point.primitive) : no_id;
        if (refracted > 0.0 && glm::dot(refraction.direction, point.normal) < 0.0)
          radiance += follow(point, path, refraction.direction, refracted, medium, counts_.refraction);
      }
    }
    if (reflected > 0.0) {
      Vec3 direction = reflect(path.direction, normal);
      if (!(glm::dot(direction, point.normal) > 0.0)) direction = reflect(path.direction, point.normal);
      radiance += follow(point, path, glm::normalize(direction), reflected, path.medium, counts_.reflection);
    }
    return radiance;
  }

  Vec3f follow(const SurfacePoint& from, const Path& path, const Vec3& direction, double share,
               std::uint32_t medium, std::uint64_t& count) {
    const Path next{direction, path.depth + 1, path.weight * share, medium};
    if (next.depth > scene_.max_depth || next.weight < options_.min_contribution) return Vec3f(0.0f);
    ++count;
    const Ray ray = tracer_.spawn_ray(from, direction);
    const std::optional<Hit> hit = tracer_.closest_hit(ray);
    if (!hit) return static_cast<float>(share) * scene_.background;
    const SurfacePoint point = tracer_.surface_point(ray, *hit);
    const auto shadow = [&](std::uint32_t i) { return transmittance(point, i); };
    Vec3f radiance = leaving(point, next, shadow);
    if constexpr (Policy::absorbs) radiance *= absorbed(medium, hit->t);
    return static_cast<float>(share) * radiance;
  }

  /// Beer-Lambert: exp(-absorption * length).
  Vec3f absorbed(std::uint32_t medium, double length) const {
    if (medium == no_id) return Vec3f(1.0f);
    return glm::exp(-scene_.materials[medium].absorption * static_cast<float>(length));
  }

  Vec3f through_glass(Ray ray) {
    Vec3f share(1.0f);
    std::uint32_t medium = no_id;
    for (int surfaces = 0; surfaces < max_glass_surfaces; ++surfaces) {
      const std::optional<Hit> hit = tracer_.closest_hit(ray);
      if (!hit) return share;
      const std::uint32_t id = world_.material_of(hit->primitive);
      const Material& material = scene_.materials[id];
      if (material.transmission <= 0.0f) return Vec3f(0.0f);
      const SurfacePoint point = tracer_.surface_point(ray, *hit);
      const bool entering =
          glm::dot(geometric_normal(world_, hit->primitive, point.position), point.normal) > 0.0;
      if constexpr (Policy::absorbs) share *= absorbed(entering ? medium : id, hit->t);
      medium = entering ? id : no_id;
      const Vec3 direction = glm::normalize(ray.direction);
      const double reflectance =
          refract(direction, point.normal, 1.0 / static_cast<double>(material.ior)).reflectance;
      share *= material.transmission * static_cast<float>(1.0 - reflectance);
      if (share == Vec3f(0.0f)) return share;
      const double end = ray.t.max - hit->t;
      ray = tracer_.spawn_ray(point, ray.direction);
      ray.t.max = end;
    }
    return Vec3f(0.0f);
  }

  const Tracer& tracer_;
  const World& world_;
  const Scene& scene_;
  const RaytraceOptions& options_;
  const std::uint64_t pixel_key_;
  std::uint64_t points_lit_ = 0;  // soft lights asked for so far
  RayCounts& counts_;
};

}  // namespace gnomon::raytrace
