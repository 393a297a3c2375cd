// Which instances of a world touch something, so that they cannot share the topology of their mesh.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "scene/math.h"
#include "scene/world.h"

namespace gnomon::raytrace {

/// Tells of each part whether it is flattened, or has a vertex where another part has one or where another one of its own
/// came to lie. It is then 1, else 0. A part may be said to touch something though it does not, when hashes of 64 bits are
/// equal. `welded`: by mesh of the scene, of each vertex the lowest one at its place; of the meshes of kept parts alone.
std::vector<char> parts_in_contact(const World& world, const std::vector<std::vector<std::uint32_t>>& welded);

// A hash of a position by its exact bits.

/// Equal positions have equal hashes; -0 equals 0.
inline std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(p[a] + 0.0)) * 0x9e3779b97f4a7c15u;  // -0 becomes 0
    hash ^= hash >> 32;
  }
  return hash;
}

}  // namespace gnomon::raytrace
