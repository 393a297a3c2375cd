// Scenes, rays and an independent oracle for the ray tracer's tests: the small scenes of `gnomon verify`,
// models from files, and 128-bit arithmetic. Randomness is seeded: a failure repeats itself. GNOMON_TEST_SEED=N in the
// environment gives other scenes and rays, for N from 1.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "verify/small_world.h"

namespace gnomon::test {

using verify::box;
using verify::in_floats;
using verify::plane;
using verify::point_light;
using verify::quad;
using verify::same;
using verify::scene_of;
using verify::seen;
using verify::sphere;
using verify::sun;
using TestWorld = verify::SmallWorld;

/// What GNOMON_TEST_SEED says; 0 without it.
std::uint64_t seed_of_environment();

struct Random : verify::Random {
  explicit Random(std::uint64_t seed) : verify::Random(seed + 0x9e3779b9u * seed_of_environment()) {}
};

/// A sphere around a place in the box of that half extent.
inline Shape some_sphere(Random& random, double half, const Interval& radii, int material = 0) {
  const double radius = random.uniform(radii.min, radii.max);
  return sphere(random.in_box(half), radius, material);
}
/// Returns a direction as long as the interval says.
inline Vec3 some_direction(Random& random, const Interval& lengths) {
  const double length = random.uniform(lengths.min, lengths.max);
  return length * random.direction();
}

/// verify::round_mesh and verify::soup with random numbers of their own.
Mesh uv_sphere(const Vec3& center, double radius, int rings, int sectors, double jitter, std::uint64_t seed);
Mesh triangle_soup(int count, double extent, double size, std::uint64_t seed);
/// Positions and faces of an OBJ file; nothing when the file is absent.
std::optional<Mesh> read_obj(const std::string& path);
/// Scaled, then moved.
Mesh moved(Mesh mesh, double scale, const Vec3& offset);
/// Moved and scaled to a unit diagonal around the origin.
Mesh normalised(Mesh mesh);

/// A hit as a 128-bit Moeller-Trumbore and textbook sphere quadratic see it: another formula in another
/// precision.
struct OracleHit {
  double t = 0.0;
  std::uint32_t primitive = no_id;
  bool doubtful =
      false;  ///< so close to an edge, a tangent or another hit that double precision may choose otherwise
};
OracleHit oracle_closest(const World& world, const Ray& ray);

}  // namespace gnomon::test
