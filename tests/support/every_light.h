// The lights of a scene, as the renderers ask for them.
#pragma once

#include <numeric>
#include <vector>

#include "scene/scene.h"

namespace gnomon::test {

inline std::vector<std::uint32_t> every_light(const Scene& scene) {
  std::vector<std::uint32_t> lights(scene.lights.size());
  std::iota(lights.begin(), lights.end(), 0u);
  return lights;
}

}  // namespace gnomon::test
