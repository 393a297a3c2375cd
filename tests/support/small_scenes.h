// Small scenes built in code, for tests that need no files.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace gnomon::test {

/// The same numbers everywhere, from a seed.
class Lcg {
 public:
  explicit Lcg(std::uint64_t seed) : state_(seed) {}
  double operator()(double low, double high) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  Vec3 point(double extent) {
    return {(*this)(-extent, extent), (*this)(-extent, extent), (*this)(-extent, extent)};
  }

 private:
  std::uint64_t state_;
};

/// A rectangular floor in the plane y = 0, as two triangles, centred at the origin.
Mesh floor_mesh(double half_width, double half_depth);
/// A closed box, outward-wound.
Mesh box_mesh(const Vec3& min, const Vec3& max);
/// A scene with one grey material, the meshes as instances, and a sun that travels along `direction`.
Scene sunlit_scene(std::vector<Mesh> meshes, const Vec3& direction);
/// A floor and two boxes under a sun, the spot light "lamp" and the point light "bulb".
Scene boxes_under_three_lights();

}  // namespace gnomon::test
