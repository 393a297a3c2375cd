// EXT_mesh_gpu_instancing: one node that shows its mesh many times.
#pragma once

#include <vector>

#include "scene/expected.h"
#include "scene/files/gltf_data.h"
#include "scene/math.h"

namespace gnomon {

/// node_from_instance of each; `extension` is the node's object of that name. Attributes that are not there
/// change nothing. The Error holds the reason alone.
Expected<std::vector<Mat4>> gltf_instances(const gltf::Model& model, const GltfData& data,
                                           const JsonValue& extension);

}  // namespace gnomon
