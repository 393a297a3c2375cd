// KHR_draco_mesh_compression: primitives packed by Draco.
#pragma once

#include <string>

#include "scene/expected.h"
#include "scene/files/gltf_data.h"

namespace gnomon {

/// Unpacks such primitives and points their accessors to new views of plain data. Where the extension is not
/// required and a primitive brings its geometry unpacked too, that is taken. Errors (bad_input): data that is
/// damaged, or that claims more triangles or vertices than so many bytes can hold.
Expected<void> unpack_draco(GltfDocument& document, GltfData& data);

}  // namespace gnomon
