// Animations of a glTF file (glTF 2.0, section 3.11) as far as they move cameras and lights.
#pragma once

#include <vector>

#include "scene/files/formats.h"
#include "scene/files/gltf_data.h"

namespace gnomon {

/// Nodes that carry what the loaded file lists, in its order.
struct CarriedNodes {
  std::vector<std::size_t> cameras, lights;
};

/// One path for each animation that moves a camera, a light or a node above one; its name, or animation-I. What else
/// it moves is said in a note. Error (bad input): a channel or a sampler that is not sound.
Expected<std::vector<LoadedPath>> read_gltf_paths(const GltfDocument& document, const GltfData& data,
                                                  const CarriedNodes& carried, Scene& scene);

}  // namespace gnomon
