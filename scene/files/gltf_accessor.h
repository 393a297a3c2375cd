// Reading glTF accessors (glTF 2.0, section 3.6.2): any component type, normalized or not, interleaved,
// sparse.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/math.h"

namespace tinygltf {
class Model;
}

namespace gnomon {

/// Element i, component c is at [i * components + c]. The file must have passed check_gltf.
struct AccessorData {
  std::size_t count = 0;
  std::size_t components = 0;
  std::vector<double> values;

  Vec2 vec2(std::size_t i) const { return {values[i * components], values[i * components + 1]}; }
  Vec3 vec3(std::size_t i) const {
    return {values[i * components], values[i * components + 1], values[i * components + 2]};
  }
};

AccessorData read_accessor(const tinygltf::Model& model, int accessor);

}  // namespace gnomon
