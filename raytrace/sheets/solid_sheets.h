// The sheets of a solid (scene/solid.h), which may be several on one side when it is not convex.
#pragma once

#include "scene/solid.h"

namespace gnomon::raytrace {

/// Two points of a solid's surface surely lie on one sheet of it: between the light rays through them the
/// surface is hit once by each ray, near the chord from one to the other. A convex solid's points on the side
/// that faces the light always do; of the others the proof is by interval arithmetic, and false may mean that
/// none was found. The directions are those of the light rays through a and b.
bool hang_together(const ShapeGeometry& solid, const Vec3& a, const Vec3& b, const Vec3& direction_a,
                   const Vec3& direction_b);

}  // namespace gnomon::raytrace
