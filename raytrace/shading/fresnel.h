// Exact unpolarised reflectance of a dielectric boundary, and the refracted direction (Born & Wolf 1999,
// section 1.5.2).
#pragma once

#include "scene/math.h"

namespace gnomon::raytrace {

struct Refraction {
  double reflectance = 1.0;  ///< share that is reflected; the rest is refracted
  Vec3 direction{0.0};       ///< unit, of the refracted ray; 0 where there is none: everything is reflected
};

/// `incoming` is unit and arrives against `normal` (unit, dot <= 0); eta is the index on the incoming side
/// over the one behind. sin^2 of the refracted angle above 1 is total reflection, never the root of a
/// negative number.
inline Refraction refract(const Vec3& incoming, const Vec3& normal, double eta) {
  const double cos_in = std::clamp(-glm::dot(incoming, normal), 0.0, 1.0);
  // 1 - (eta sin)^2 without the cancellation at eta near 1.
  const double cos_out_squared = (1.0 - eta) * (1.0 + eta) + (eta * cos_in) * (eta * cos_in);
  if (!(cos_out_squared >= 0.0)) return {};
  const double cos_out = std::sqrt(cos_out_squared);
  const double across = eta * cos_in + cos_out;  // s polarisation: electric field along the surface
  const double along = cos_in + eta * cos_out;   // p polarisation
  const bool grazes = !(across > 0.0) || !(along > 0.0);
  if (grazes) return {};
  const double s = (eta * cos_in - cos_out) / across;
  const double p = (cos_in - eta * cos_out) / along;
  // Along the boundary, then through it: near the critical angle cos_out keeps all its places.
  const Vec3 direction = glm::normalize(eta * (incoming + cos_in * normal) - cos_out * normal);
  return {0.5 * (s * s + p * p), direction};
}

inline Vec3 reflect(const Vec3& incoming, const Vec3& normal) {
  return incoming - 2.0 * glm::dot(incoming, normal) * normal;
}

}  // namespace gnomon::raytrace
