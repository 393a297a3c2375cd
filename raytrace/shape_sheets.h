// The sheets of analytic shapes inside one column: a sphere's near and far side, bounded by its silhouette,
// a plane, bounded by its horizon, and a solid (scene/solid.h), bounded everywhere unless proven otherwise.
#pragma once

#include <vector>

#include "raytrace/column.h"
#include "raytrace/sheets.h"
#include "scene/solid.h"

namespace gnomon::raytrace {

void append_sphere_sheets(const Sphere& sphere, std::uint32_t id, bool masked, const Column& column,
                          std::vector<Sheet>& sheets);
void append_solid_sheets(const ShapeGeometry& solid, std::uint32_t id, bool masked, const Column& column,
                         std::vector<Sheet>& sheets);
void append_plane_sheet(const Plane& plane, std::uint32_t id, bool masked, const Column& column,
                        std::vector<Sheet>& sheets);

}  // namespace gnomon::raytrace
