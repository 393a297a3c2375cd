// What passes between edge_setup.cpp's drivers and edge_setup_kernel.cpp, which is compiled once per instruction set.
#pragma once

#include <span>

#include "raytrace/packets/edge_setup.h"

namespace gnomon::raytrace {

/// Eight triangles by rows: nine corner coordinates in; edges (9), reciprocal depth (3) and the three bounds
/// out, those rounded up, in the order of PrimitiveEdges; PrimitiveBounds after them.
struct alignas(64) EdgeSetupRows {
  static constexpr std::size_t numbers = 15, bounds = 5, count = numbers + bounds;
  double corner[9][8];
  float out[count][8];
};

struct EdgeSetupPass {
  Vec3 origin;
  Vec3 axes[3];
  double largest = 0.0;   ///< no coordinate in the pass is larger
  double radius = 0.0;    ///< of the world, for a direction
  double farthest = 0.0;  ///< for a direction: no corner is farther from any receiver
  bool directional = false;
};

EdgeSetupPass edge_setup_pass(const Structures& structures, const EdgeSetup& setup);

/// Eight leaves' numbers.
struct EdgeSetupBlock {
  EdgeSetupRows rows;
  const float* u_min() const { return rows.out[EdgeSetupRows::numbers]; }
  const float* u_max() const { return rows.out[EdgeSetupRows::numbers + 1]; }
  const float* v_min() const { return rows.out[EdgeSetupRows::numbers + 2]; }
  const float* v_max() const { return rows.out[EdgeSetupRows::numbers + 3]; }
  const float* nearest() const { return rows.out[EdgeSetupRows::numbers + 4]; }
};
/// Up to eight leaves by their numbers, of which those that are no triangles are void. Bit i: the i-th is never
/// sure.
unsigned set_up_leaves(const Structures& structures, const EdgeSetupPass& pass,
                       std::span<const std::uint32_t> leaves, EdgeSetupBlock& block);

/// Corners in, numbers out.
void set_up_eight_triangles(EdgeSetupRows& rows, const EdgeSetupPass& pass);

}  // namespace gnomon::raytrace
