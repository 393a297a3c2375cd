// A hash of a position by its exact bits.
#pragma once

#include <bit>
#include <cstdint>

#include "scene/math.h"

namespace gnomon::raytrace {

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
