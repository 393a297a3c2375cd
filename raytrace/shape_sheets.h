// The sheets of analytic shapes inside one column: a sphere's near and far side, bounded by its silhouette,
// and a plane, bounded by its horizon.
#pragma once

#include <vector>

#include "raytrace/column.h"
#include "raytrace/sheets.h"

namespace gnomon::raytrace {

void append_sphere_sheets(const Sphere& sphere, std::uint32_t id, bool masked, const Column& column,
                          std::vector<Sheet>& sheets);
void append_plane_sheet(const Plane& plane, std::uint32_t id, bool masked, const Column& column,
                        std::vector<Sheet>& sheets);

}  // namespace gnomon::raytrace
