// Small scenes built in code, for tests that need no files.
#pragma once

#include <numeric>
#include <vector>

#include "scene/scene.h"

namespace gnomon::test {

/// A rectangular floor in the plane y = 0, as two triangles, centred at the origin.
Mesh floor_mesh(double half_width, double half_depth);
/// A closed box, outward-wound.
Mesh box_mesh(const Vec3& min, const Vec3& max);
/// A scene with one grey material, the meshes as instances, and a sun that travels along `direction`.
Scene sunlit_scene(std::vector<Mesh> meshes, const Vec3& direction);
/// A floor and two boxes under a sun, the spot light "lamp" and the point light "bulb".
Scene boxes_under_three_lights();

/// The lights of a scene, as the renderers ask for them.
inline std::vector<std::uint32_t> every_light(const Scene& scene) {
  std::vector<std::uint32_t> lights(scene.lights.size());
  std::iota(lights.begin(), lights.end(), 0u);
  return lights;
}

}  // namespace gnomon::test
