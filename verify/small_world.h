// The small scenes that the cases and the tests of rays are made of: in a library of their own, which needs
// no rasterizer.
#pragma once

#include <optional>
#include <vector>

#include "raytrace/tracer.h"
#include "scene/generate/random.h"
#include "scene/world.h"

namespace gnomon::verify {

// Seeded random numbers for trials and for the small scenes: a failure repeats itself on every machine.

/// SplitMix64, the generators' own bits, with what aimed rays need. Any two seeds give unrelated sequences.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::uint64_t next() { return bits_.bits(); }
  double uniform(double lo, double hi) { return bits_.between(lo, hi); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((next() >> 32) * n >> 32); }
  int integer(int lo, int hi) {
    return lo + static_cast<int>(below(static_cast<std::uint32_t>(hi - lo + 1)));
  }
  bool coin() { return (next() >> 63) != 0; }
  double power_of_ten(double lo, double hi) { return std::pow(10.0, uniform(lo, hi)); }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction();
  /// Moved by up to `steps` representable numbers per component.
  Vec3 nudged(const Vec3& p, int steps);

 private:
  gnomon::Random bits_;
};

/// A scene with its world; pinned in memory, for the world points into the scene.
class SmallWorld {
 public:
  explicit SmallWorld(Scene scene) : scene_(std::move(scene)), world_(make_world(scene_)) {}
  explicit SmallWorld(Mesh mesh);
  explicit SmallWorld(std::vector<Shape> shapes);
  SmallWorld(std::vector<Mesh> meshes, std::vector<Shape> shapes);
  SmallWorld(const SmallWorld&) = delete;
  SmallWorld& operator=(const SmallWorld&) = delete;
  const Scene& scene() const { return scene_; }
  const World& world() const { return world_; }

 private:
  Scene scene_;
  World world_;
};

/// One grey material, the meshes as instances, the shapes as they are.
Scene scene_of(std::vector<Mesh> meshes, std::vector<Shape> shapes = {});
Shape sphere(const Vec3& center, double radius, std::uint32_t material = 0);
Shape plane(const Vec3& point, const Vec3& unit_normal, std::uint32_t material = 0);
Mesh quad(const Vec3& origin, const Vec3& edge_a, const Vec3& edge_b);
Mesh box(const Vec3& min, const Vec3& max);
Mesh soup(int count, double extent, double size, Random& random);
/// A closed sphere of rings x sectors quads, two triangles each, outward-wound, its vertices moved along the
/// radius by up to this share.
Mesh round_mesh(const Vec3& center, double radius, int rings, int sectors, double jitter, Random& random);
/// Its corners rounded to float: every precision, and every other tracer, is given the same mesh.
Mesh in_floats(Mesh mesh);
Light point_light(const Vec3& position);
Light sun(const Vec3& direction);

/// The point where a ray from eye to target first meets the world; primitive == no_id where it does not.
raytrace::SurfacePoint seen(const raytrace::Tracer& tracer, const Vec3& eye, const Vec3& target);

/// Tells whether two hits are the same to the last bit.
bool same(const std::optional<raytrace::Hit>& a, const std::optional<raytrace::Hit>& b);

}  // namespace gnomon::verify
