// Polygons of model files, cut into triangles by ear clipping (Meisters 1975): concave ones come out right,
// and n corners always give n - 2 triangles, however degenerate or self-crossing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/math.h"

namespace gnomon {

/// Loaders refuse more: to triangulate a polygon takes time with the square of its corners.
inline constexpr std::size_t max_polygon_corners = 4096;

/// Triangles as indices into `corners` (at least three), wound as the polygon is.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace gnomon
