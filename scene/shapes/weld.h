// Which positions of a mesh are the same, however often it has them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/math.h"

namespace gnomon {

/// Numbers the positions so that equal ones have one number, which is less than their count.
std::vector<std::uint32_t> welded(std::span<const Vec3> positions);

}  // namespace gnomon
