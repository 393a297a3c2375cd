// What passes between seen.cpp's drivers and seen_kernel.cpp, which is compiled once per instruction set.
#pragma once

#include "scene/math.h"

namespace gnomon::raytrace {

/// Eight triangles by rows: nine corner coordinates in; edges (9), nearness (3) and the three bounds out,
/// those rounded up, in the order of SeenPrimitive.
struct alignas(64) SeenRows {
  static constexpr std::size_t count = 15;
  double corner[9][8];
  float seen[count][8];
};

struct SeenPass {
  Vec3 origin;
  Vec3 axes[3];
  double largest = 0.0;  ///< no coordinate in the pass is larger
  double radius = 0.0;   ///< of the world, for a direction
  bool directional = false;
};

/// Corners in, numbers out.
void see_eight_triangles(SeenRows& rows, const SeenPass& pass);

}  // namespace gnomon::raytrace
