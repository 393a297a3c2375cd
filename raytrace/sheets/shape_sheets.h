// The sheets of analytic shapes inside one column: a sphere's near and far side, bounded by its silhouette,
// a plane, bounded by its horizon, and a solid (scene/solid.h), bounded everywhere unless proven otherwise.
#pragma once

#include <vector>

#include "raytrace/sheets.h"
#include "raytrace/sheets/column.h"
#include "scene/solid.h"

namespace gnomon::raytrace {

void append_sphere_sheets(const Sphere& sphere, std::uint32_t id, bool masked, const TexelColumn& column,
                          std::vector<Sheet>& sheets);
void append_solid_sheets(const ShapeGeometry& solid, std::uint32_t id, bool masked, const TexelColumn& column,
                         std::vector<Sheet>& sheets);
/// Two points of a solid's surface surely lie on one sheet of it: between the light rays through them the
/// surface is hit once by each ray, near the chord from one to the other. A convex solid's points on the side
/// that faces the light always do; of the others the proof is by interval arithmetic, and false may mean that
/// none was found. The directions are those of the light rays through a and b.
bool hang_together(const ShapeGeometry& solid, const Vec3& a, const Vec3& b, const Vec3& direction_a,
                   const Vec3& direction_b);
void append_plane_sheet(const Plane& plane, std::uint32_t id, bool masked, const TexelColumn& column,
                        std::vector<Sheet>& sheets);

}  // namespace gnomon::raytrace
