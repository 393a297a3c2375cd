// Scenes, rays and an independent oracle for the ray tracer's tests: the small scenes of `gnomon verify`,
// models from files, and 128-bit arithmetic. Randomness is seeded: a failure repeats itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/verify/small_world.h"

namespace gnomon::test {

using verify::box;
using verify::in_floats;
using verify::plane;
using verify::point_light;
using verify::quad;
using verify::Random;
using verify::same;
using verify::scene_of;
using verify::seen;
using verify::sphere;
using verify::sun;
using TestWorld = verify::SmallWorld;

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
