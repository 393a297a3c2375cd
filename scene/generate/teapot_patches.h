// The teapot that Martin Newell published in 1975 ("The Utilization of Procedure Models in Digital Image
// Synthesis", PhD thesis, University of Utah): 32 bicubic Bezier patches. They are in the symmetric form that
// his table of 306 points repeats: rings of revolution, and the handle's and the spout's sections. Newell's
// units and axes: z is up, the spout points to +x, the foot is at z = 0, the knob ends at 3.15.
#pragma once

#include <array>
#include <vector>

#include "scene/math.h"

namespace gnomon::teapot {

using Patch = std::array<std::array<Vec3, 4>, 4>;  ///< [along the profile][around]

inline constexpr double height = 3.15;

enum class Piece : std::uint8_t { body, lid, handle, spout };

struct NamedPatch {
  Piece piece;
  Patch patch;  ///< dp/d(column) x dp/d(row) points outwards
};

/// The 32 patches: rim 4, body 8, bottom 4, lid 8, handle 4, spout 4.
std::vector<NamedPatch> patches();

/// p at (row parameter u, column parameter v) in [0, 1]^2. An edge that two patches share comes out bitwise
/// equal from both when it is sampled at i/n: the sum is symmetric under reversal (`one_minus_u` is passed
/// for that reason).
Vec3 evaluate(const Patch& patch, double u, double one_minus_u, double v, double one_minus_v);

/// Unit normal; where a row of the patch collapses to a point, the limit.
Vec3 normal(const Patch& patch, double u, double v);

}  // namespace gnomon::teapot
