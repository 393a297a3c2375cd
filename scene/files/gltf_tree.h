// The tree of a glTF file's nodes: every node has at most one parent and is not its own ancestor (glTF 2.0,
// section 3.5.2).
#pragma once

#include <vector>

#include "scene/files/json_reader.h"

namespace gnomon {

/// Says the first mistake through the node that makes it. The indices of children are valid already.
void check_gltf_tree(const std::vector<JsonNode>& nodes);

}  // namespace gnomon
