// What passes between seen.cpp's drivers and seen_kernel.cpp, which is compiled once per instruction set.
#pragma once

#include <span>

#include "raytrace/packets/seen.h"

namespace gnomon::raytrace {

/// Eight triangles by rows: nine corner coordinates in; edges (9), nearness (3) and the three bounds out,
/// those rounded up, in the order of SeenPrimitive; where asked for, SeenBounds after them.
struct alignas(64) SeenRows {
  static constexpr std::size_t numbers = 15, bounds = 5, count = numbers + bounds;
  double corner[9][8];
  float seen[count][8];
};

struct SeenPass {
  Vec3 origin;
  Vec3 axes[3];
  double largest = 0.0;   ///< no coordinate in the pass is larger
  double radius = 0.0;    ///< of the world, for a direction
  double farthest = 0.0;  ///< for a direction: no corner is farther from any receiver
  bool directional = false;
  bool turned = false;  ///< the axes are not the world's
  bool bounds = false;  ///< SeenBounds are asked for
};

SeenPass seen_pass(const Structures& structures, const Seen& seen);

/// Eight leaves from `first` on, or as many as there are (those beyond: no ray). pass.bounds must be set.
struct SeenBlock {
  SeenRows rows;
  const float* u_min() const { return rows.seen[SeenRows::numbers]; }
  const float* u_max() const { return rows.seen[SeenRows::numbers + 1]; }
  const float* v_min() const { return rows.seen[SeenRows::numbers + 2]; }
  const float* v_max() const { return rows.seen[SeenRows::numbers + 3]; }
  const float* nearest() const { return rows.seen[SeenRows::numbers + 4]; }
};
void see_block(const Structures& structures, const SeenPass& pass, std::size_t first, SeenBlock& block);
/// The block's i-th, which is this leaf.
SeenPrimitive primitive_in(const Structures& structures, const SeenBlock& block, std::size_t i,
                           std::size_t leaf);

/// The same for up to eight leaves by their numbers, of which those that are no triangles are void. Bit i:
/// the i-th is never sure.
unsigned see_leaves(const Structures& structures, const SeenPass& pass, std::span<const std::uint32_t> leaves,
                    SeenBlock& block);

/// Corners in, numbers out.
void see_eight_triangles(SeenRows& rows, const SeenPass& pass);

}  // namespace gnomon::raytrace
