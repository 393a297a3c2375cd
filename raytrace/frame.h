// What the ray tracer hands on, and the call that makes it. Pixel arrays are row-major, row 0 at the top.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "raytrace/tracer.h"
#include "scene/base/timing.h"
#include "scene/camera.h"
#include "scene/effects.h"
#include "scene/image.h"

namespace gnomon::raytrace {

struct RaytraceOptions {
  ImageSize size{1280, 720};
  /// Timed repetitions of the primary and shadow passes (>= 1), at most: no further one once those made took
  /// enough_ms together.
  int runs = 1;
  double enough_ms = never_enough_ms;
  bool warm_up = false;  ///< trace the same in small first, untimed
  bool picture = true;   ///< shade and follow secondary rays; false: receivers and shadows only
  double min_contribution = 1.0 / 512.0;  ///< secondary rays below this share of a pixel are not followed
  int shadow_samples =
      0;  ///< rays per point to a light with size, <= max_shadow_samples; 0: as the light says
  std::uint64_t seed = 0;  ///< of every sample
  /// The picture's shadow rays start on the smooth body that a mesh stands for (raytrace/shading/smooth_surface.h), and its
  /// shading normal says what faces a light. Receivers and lights of the frame are the triangles' all the same.
  bool terminator_offset = false;
  /// The picture's; a box filter. What else the frame holds is of pixel centres. 1: the picture too.
  int samples_per_pixel = 1;
  /// false: only the picture is wanted, so no ray is cast that it does not need. Lights with size then have
  /// no shadows, and with several samples per pixel there are neither receivers nor lights.
  bool records = true;
  /// A request ends the call at the next tile; what it returns is then not to be read. The tracer stays whole.
  std::stop_token stop{};
  bool operator==(const RaytraceOptions&) const = default;
};

/// Rays per point to a light with size.
inline int samples_of(const Light& light, const RaytraceOptions& options) {
  return options.shadow_samples > 0 ? options.shadow_samples : light.shadow_samples;
}

struct RayCounts {
  std::uint64_t primary = 0;
  // Rays cast: behind each surface of glass on the way to a light, which the picture's shadows look through, goes on
  // another one.
  std::uint64_t shadow = 0;       ///< to lights without size, and to the centres of those with one
  std::uint64_t soft_shadow = 0;  ///< to samples of lights with size
  /// The samples that were wanted: of them none is cast below a point's own horizon, and none at all where
  /// nothing surely stands between point and light (raytrace/shading/light_shaft.h).
  std::uint64_t soft_shadow_asked = 0;
  std::uint64_t reflection = 0, refraction = 0;  ///< sharp ones
  std::uint64_t glossy = 0;                      ///< that leave rough mirrors and rough glass
  std::uint64_t indirect = 0;                    ///< that gather light reflected once
  std::uint64_t antialiasing = 0;                ///< from the eye, beyond `primary`
  std::uint64_t interior = 0;                    ///< to find the glass that the eye is in
  /// All that refraction costs.
  std::uint64_t for_refraction() const { return refraction + interior; }
  RayCounts& operator+=(const RayCounts& other);
};

struct LightTruth {
  std::uint32_t light = 0;  ///< index in Scene::lights
  /// Holds the visibility of the light's centre: lit where there is no receiver, shadowed where the light cannot reach
  /// (facing away).
  Image<PointVisibility> centre;
  Times shadow_rays;       ///< ms for the pixels that the light can reach
  Times light_structure;   ///< the part of each of these runs that made the light's own structure; 0 of none
  std::uint64_t rays = 0;  ///< cast
  std::uint64_t single_rays = 0;  ///< of these, traced one by one and not by packets

  /// A light with size: the share of it that each pixel's receiver sees, 1 where there is none, 0 where the
  /// light's centre cannot reach it. Empty for a light without size, whose centre is the whole of it.
  Image<float> visibility{};
  Image<float> standard_error{};                     ///< of `visibility`, estimated from its samples
  int samples = 0;                                   ///< rays per point
  Times soft_shadow_rays{};                          ///< ms
  std::uint64_t soft_rays = 0, soft_rays_asked = 0;  ///< as RayCounts::soft_shadow, soft_shadow_asked

  bool is_soft() const { return !visibility.data.empty(); }
  /// What the exact shadow took: of a light with size its samples, not the rays to its centre, which say
  /// where the shadow of a light without size would lie.
  const Times& exact_times() const { return is_soft() ? soft_shadow_rays : shadow_rays; }
  std::uint64_t exact_rays() const { return is_soft() ? soft_rays : rays; }
};

struct RayTracedFrame {
  RaytraceOptions options;
  ColorImage color;              ///< linear radiance
  Image<SurfacePoint> receiver;  ///< primitive == no_id: background
  std::vector<LightTruth> lights;
  RayCounts rays;
  Times primary_rays;
  Times structure;          ///< time_structure(), up to the shadow rays
  double picture_ms = 0.0;  ///< shading and secondary rays
  std::uint64_t non_finite =
      0;  ///< samples of the picture whose radiance was NaN or infinite; they are black
};

/// Bit-identical for any number of threads (oneTBB's global limit decides how many).
RayTracedFrame trace_frame(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                           std::span<const std::uint32_t> lights, const RaytraceOptions& options);

// Parts of a picture, for pictures whose numbers would not all fit into memory at one time.

/// Makes those rows of the picture that trace_frame makes with these options, to the last bit; row 0 of the frame's images
/// is rows.first, options.size stays that of the whole. What the frame counts are the rows' rays, but for
/// RayCounts::interior, which each band asks for again.
RayTracedFrame trace_band(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                          std::span<const std::uint32_t> lights, const RaytraceOptions& options,
                          const PictureRows& rows);

/// Counts and times of the band after those of the bands before it, whose images stay as they are.
void add_costs(const RayTracedFrame& band, RayTracedFrame& sum);

}  // namespace gnomon::raytrace
