// Rays from a surface point to a light with size, sampled as its shape says (scene/light_shape/). So the share of the rays
// that arrive is the share of the light's solid angle, or of its area, that the point sees. What lies below the point's own
// horizon is not seen.
#pragma once

#include <optional>
#include <span>

#include "raytrace/shading/sampling.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {

class LightSamples {
 public:
  /// The light has a size; all must outlive the samples.
  LightSamples(const Tracer& tracer, const SurfacePoint& from, const Light& light, int count,
               std::uint64_t key);

  int count() const { return count_; }
  /// The i-th ray as Tracer::shadow_ray makes it; none for a sample below the horizon.
  std::optional<Ray> operator[](int i) const;

 private:
  Ray ray(const Vec2& square) const;
  bool below_horizon(const Vec3& direction) const;

  const Tracer& tracer_;
  const SurfacePoint& from_;
  bool endless_;
  int count_;
  StratifiedSquare square_;
  LightSampler sampler_;
};

/// What one point sees of a light.
struct SampledVisibility {
  double share = 1.0;           ///< in [0, 1]
  double standard_error = 0.0;  ///< of `share` as an estimate by its samples; 0 where all agree
  std::uint64_t rays = 0;       ///< cast for it
};

/// The standard error of the mean of stratified samples that are 0 or 1, in the order of StratifiedSquare. The
/// points of four neighbouring strata (two by two) differ from the mean's trend by what one stratum's choice
/// changes. Of fewer than 16 there are fewer than four such groups to tell by. It is then the standard error of
/// samples without strata, which is no smaller. Of one sample nothing can be told: 0.
double stratified_standard_error(std::span<const std::uint8_t> samples);

/// Any unmasked surface occludes, glass too.
SampledVisibility light_visibility(const Tracer& tracer, const SurfacePoint& from, const Light& light,
                                   int samples, std::uint64_t key);

}  // namespace gnomon::raytrace
