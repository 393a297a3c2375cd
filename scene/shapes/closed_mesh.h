// Whether a mesh has an inside: every edge (vertices welded by position) belongs to an even number of
// triangles. Then every line that avoids edges crosses it an even number of times, whatever its winding.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scene/math.h"

namespace gnomon {

using MeshTriangle = std::array<std::uint32_t, 3>;

/// Edges with an odd number of triangles; triangles with two equal corners do not count. 0: the mesh is
/// closed. Corners are indices into positions.
std::uint64_t open_edges(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles);

}  // namespace gnomon
