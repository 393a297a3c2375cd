// The structure of a glTF file as tinygltf reads it.
#pragma once

#include <tiny_gltf.h>

#include "scene/expected.h"
#include "scene/files/gltf_check.h"

namespace gnomon {

/// Without buffers, images, skins and animations: gltf_data.h and gltf_skins.h read those from the checked
/// JSON, and nothing is copied.
Expected<tinygltf::Model> parse_gltf(const CheckedGltf& checked);

}  // namespace gnomon
