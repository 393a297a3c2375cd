// Scenes, rays and an independent oracle for the ray tracer's tests. Randomness is seeded: a failure repeats
// itself.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "raytrace/tracer.h"
#include "scene/scene.h"
#include "scene/world.h"

namespace gnomon::test {

/// A scene with its world; pinned in memory, for the world points into the scene.
class TestWorld {
 public:
  explicit TestWorld(Scene scene);
  TestWorld(const TestWorld&) = delete;
  TestWorld& operator=(const TestWorld&) = delete;
  const Scene& scene() const { return scene_; }
  const World& world() const { return world_; }

 private:
  Scene scene_;
  World world_;
};

/// One grey material, the meshes as instances, the shapes as they are.
Scene scene_of(std::vector<Mesh> meshes, std::vector<Shape> shapes = {});
Shape sphere(const Vec3& center, double radius, std::uint32_t material = 0);
Shape plane(const Vec3& point, const Vec3& normal, std::uint32_t material = 0);

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction();
  /// Moved by up to `steps` representable numbers per component.
  Vec3 nudged(Vec3 p, int steps);

 private:
  std::mt19937_64 engine_;
};

Mesh quad(const Vec3& origin, const Vec3& edge_a, const Vec3& edge_b);
Mesh box(const Vec3& min, const Vec3& max);
/// A closed triangulated sphere of rings x sectors quads, outward-wound, vertices jittered along the radius.
Mesh uv_sphere(const Vec3& center, double radius, int rings, int sectors, double jitter, std::uint64_t seed);
Mesh triangle_soup(int count, double extent, double size, std::uint64_t seed);
/// Positions and faces of an OBJ file; nothing when the file is absent.
std::optional<Mesh> read_obj(const std::string& path);
/// Moved and scaled to a unit diagonal around the origin.
Mesh normalised(Mesh mesh);
Light point_light(const Vec3& position);
Light sun(const Vec3& direction);

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
