// What glTF 2.0 allows and tinygltf refuses: a buffer that is longer than its byteLength, and a skin without
// inverseBindMatrices.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/files/gltf_check.h"
#include "scene/load.h"

namespace gnomon {

/// The file with such lengths and skins written as tinygltf wants them; nothing where there are none. Skins are not
/// applied, so that it does not matter what their matrices are.
std::optional<std::string> repaired_gltf(const CheckedGltf& checked, std::string_view bytes,
                                         const std::string& folder, const LoadOptions& options);

}  // namespace gnomon
