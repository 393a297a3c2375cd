// Which side of a triangle a ray meets, and which sides are seen at all (scene/scene.h, shows_back).
#pragma once

#include <cstdint>

#include "scene/math.h"
#include "scene/world.h"

namespace gnomon::raytrace {

/// Whether a ray of this direction meets the triangle from behind: the exact sign of dot(direction, normal), whatever
/// arithmetic the hit was found with. An edge-on triangle is not met from behind.
bool is_back(const World& world, const Vec3& direction, std::uint32_t triangle);

enum class Facing : std::uint8_t { front, back, ambiguous };

/// The side of a triangle, corner after corner, that every ray from `eye` meets which meets it; ambiguous where doubles
/// do not decide it.
Facing facing_of(const double* corners, const Vec3& eye);

}  // namespace gnomon::raytrace
