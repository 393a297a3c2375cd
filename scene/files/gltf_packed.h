// What glTF files pack: primitives by Draco (KHR_draco_mesh_compression), bufferViews by meshoptimizer
// (EXT_meshopt_compression and KHR_meshopt_compression).
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scene/expected.h"
#include "scene/files/gltf_data.h"

namespace gnomon {

/// Unpacks such primitives and points their accessors to new views of plain data. Where the extension is not
/// required and a primitive brings its geometry unpacked too, that is taken. Errors (bad_input): data that is
/// damaged, or that claims more triangles or vertices than so many bytes can hold.
Expected<void> unpack_draco(GltfDocument& document, GltfData& data);

/// The bytes of the view, unpacked. `extension` is the view's object of that name; `buffers` are the file's;
/// `byte_length` is the view's own. The Error holds the reason alone. A size that the packed bytes cannot
/// fill is refused before anything is allocated.
Expected<std::vector<char>> unpack_meshopt(const JsonValue& extension,
                                           std::span<const std::string_view> buffers, double byte_length);

}  // namespace gnomon
