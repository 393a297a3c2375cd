// Instances under every kind of transform, and rays aimed where rounding between a mesh's space and the world's could
// lose a hit.
#pragma once

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "tests/support/raytrace_support.h"

namespace gnomon::test {

inline Scene instances_of(std::vector<Mesh> meshes,
                          const std::vector<std::pair<std::uint32_t, Mat4>>& placed) {
  Scene scene = scene_of(std::move(meshes));
  scene.instances.clear();
  for (const auto& [mesh, matrix] : placed) scene.instances.push_back({"instance", mesh, matrix, 0});
  return scene;
}

inline Mat4 turned(Random& random) {
  const double angle = random.uniform(0.0, 2.0 * pi);
  return glm::rotate(Mat4(1.0), angle, random.direction());
}

/// Any affine map whose columns are neither short nor nearly in a plane.
inline Mat4 sheared(Random& random) {
  for (;;) {
    Mat3 m{random.in_box(1.0), random.in_box(1.0), random.in_box(1.0)};
    if (std::abs(glm::determinant(m)) > 0.1) return Mat4(m);
  }
}

inline Mat4 moved(const Vec3& by, const Mat4& matrix) {
  return glm::translate(Mat4(1.0), by) * matrix;
}

/// To a place in the box of that half extent around `middle`.
inline Mat4 moved_into_box(const Mat4& matrix, double half, Random& random, const Vec3& middle = Vec3(0.0)) {
  return moved(middle + random.in_box(half), matrix);
}

inline Mat4 scaling(const Vec3& factors) {
  return glm::scale(Mat4(1.0), factors);
}

struct Kind {
  const char* name;
  Mat4 (*linear)(Random&);
  double extent;  ///< of the places, world units
};

inline const std::array<Kind, 9> kinds{{
    {"rotated", turned, 6.0},
    {"mirrored",
     [](Random& r) {
       return turned(r) * scaling({1.0, 1.0, -1.0});
     },
     6.0},
    {"sheared", sheared, 6.0},
    {"non-uniform",
     [](Random& r) {
       const Mat4 first = turned(r) * scaling({2.0, 0.01, 0.3});
       return first * turned(r);
     },
     6.0},
    {"thin as paper",
     [](Random& r) {
       return turned(r) * scaling({1.0, 1e-6, 1.0});
     },
     6.0},
    {"tiny", [](Random& r) { return sheared(r) * scaling(Vec3(1e-7)); }, 6e-7},
    {"tiny and far apart", [](Random& r) { return turned(r) * scaling(Vec3(1e-4)); }, 6.0},
    {"huge", [](Random& r) { return sheared(r) * scaling(Vec3(1e7)); }, 6e7},
    {"of all sizes",
     [](Random& r) {
       const Mat4 rotation = turned(r);
       return rotation * scaling(Vec3(std::exp(r.uniform(-9.0, 1.0))));
     },
     6.0},
}};

inline std::vector<Ray> aimed_rays(const World& world, int count, double extent, const Vec3& middle,
                                   std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t triangle = random.below(world.triangle_count());
    const auto [p, q, r] = world.corners(triangle);
    const Mat3 m(world.scene->instances[world.object_of(triangle)].world_from_object);
    const Vec3 on_edge = p + random.uniform(0.0, 1.0) * (q - p);
    const Vec3 from = middle + random.in_box(1.5 * extent);
    const Vec3 along = m[static_cast<int>(random.below(3))];  // an axis of the object's
    Vec3 axis(0.0);
    axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
    const double reach = extent / std::max(glm::length(along), 1e-300);
    const std::array<Ray, 7> all{{{from, random.nudged(p, 1) - from},
                                  {from, on_edge - from},
                                  {p - reach * along, along},
                                  {on_edge - 0.3 * reach * along, along},
                                  {on_edge - 2.0 * extent * axis, axis},
                                  {p - 3.0 * (q - p), q - p},
                                  {from, (on_edge - from) * 1e-9, {0.0, 2e9}}}};
    rays.push_back(all[static_cast<std::size_t>(i) % all.size()]);
  }
  return rays;
}

inline Mesh ball() {
  return test::uv_sphere(Vec3(0.3, -0.2, 0.1), 0.8, 6, 8, 0.1, 3);
}

}  // namespace gnomon::test
