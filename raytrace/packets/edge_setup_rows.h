// What passes between edge_setup.cpp's drivers and edge_setup_kernel.cpp, which is compiled once per instruction set.
#pragma once

#include <span>

#include "raytrace/packets/edge_setup.h"

namespace gnomon::raytrace {

/// Eight triangles' numbers by rows: edges (9), reciprocal depth (3) and the three bounds, those rounded up, in the order of
/// PrimitiveEdges.
struct alignas(64) EdgeSetupRows {
  static constexpr std::size_t together = 8, count = 15;
  float out[count][together];
  const float* edge_error() const { return out[12]; }
  void set(std::size_t i, const PrimitiveEdges& p) {
    for (std::size_t k = 0; k < 9; ++k) out[k][i] = p.edge[k / 3][k % 3];
    for (std::size_t k = 0; k < 3; ++k) out[9 + k][i] = p.reciprocal_depth[k];
    out[12][i] = p.edge_error, out[13][i] = p.depth_error, out[14][i] = p.depth_floor;
  }
};

struct EdgeSetupPass {
  Vec3 origin{0.0};
  Vec3 axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  double largest = 0.0;   ///< no coordinate in the pass is larger
  double radius = 0.0;    ///< of the world, for a direction
  double farthest = 0.0;  ///< for a direction: no corner is farther from any receiver
  bool directional = false;
};

EdgeSetupPass edge_setup_pass(const Structures& structures, const EdgeSetup& setup);

struct TriangleMask;

/// Up to eight leaves by their numbers, of which those that are no triangles are void. Bit i: the i-th is never
/// sure. `masks`: as many, where to put what is known of the masked triangles' masks.
unsigned set_up_leaves(const Structures& structures, const EdgeSetupPass& pass,
                       std::span<const std::uint32_t> leaves, EdgeSetupRows& rows, TriangleMask* masks);

void set_up_eight_triangles(std::span<const CornerPointers, EdgeSetupRows::together> triangles,
                            const EdgeSetupPass& pass, EdgeSetupRows& rows);

}  // namespace gnomon::raytrace
