// Where rays of a common origin or direction meet the alpha mask of a triangle, in floats. Its texture's coordinates
// are quotients of linear functions on the plane of the rays (edge_setup.h).
#pragma once

#include "raytrace/packets/edge_setup_rows.h"
#include "raytrace/shapes/mask_cells.h"

namespace gnomon::raytrace {

/// A ray at (u + du, v + dv) that is surely inside the triangle meets, to within a texel, the lattice of texel centres
/// (MaskCells). The place is x.(du, dv, 1) / w.(du, dv, 1) and y.(du, dv, 1) / w.(du, dv, 1).
struct TriangleMask {
  const MaskCells* cells = nullptr;  ///< null: that is not known
  float u, v;                        ///< of its first corner
  float x[3], y[3], w[3];
};

/// Prepares a masked triangle; of one that casts no shadow nothing is known.
TriangleMask triangle_mask(const Structures& structures, const EdgeSetupPass& pass, std::uint32_t id,
                           const CornerPointers& corners);

}  // namespace gnomon::raytrace
