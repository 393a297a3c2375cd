// The nearest hit of a ray as Moeller-Trumbore and the textbook quadratic see it in 128 bits, over every
// primitive in turn.
#pragma once

#include "scene/ray.h"
#include "scene/world.h"

namespace gnomon::verify {

struct OracleHit {
  double t = 0.0;
  std::uint32_t primitive = no_id;
  bool doubtful = false;  ///< so close to an edge, a tangent or another hit that doubles may choose otherwise
};
/// Triangles and spheres, of sizes from 0.01 to 10 and within 1e2 of the ray's origin.
OracleHit oracle_closest(const World& world, const Ray& ray);

}  // namespace gnomon::verify
