// Which instances of a world touch something, so that they cannot share the topology of their mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace gnomon::raytrace {

/// Of each part whether it is flattened, or has a vertex where another part has one, or where another one of its own
/// came to lie (then 1, else 0). A part may be said to touch something though it does not, when hashes of 64 bits are
/// equal. `welded`: by mesh of the scene, of each vertex the lowest one at its place; of the meshes of kept parts alone.
std::vector<char> touching_parts(const World& world, const std::vector<std::vector<std::uint32_t>>& welded);

}  // namespace gnomon::raytrace
