// A ray as the wide tree sees it: floats that count from the tree's centre, and how far they may be off.
//
// Notation: e = 2^-24, u = 2^-53; d the ray's direction scaled so that its largest component is in [1/2, 1),
// o its origin from the centre, r = `reach`, q >= |o|, all in the maximum norm. No float here overflows, and
// none that underflows is missed, because 2^-30 <= r <= 2^30 and q <= 64 r; other rays are refused, and walk
// the plain way.
//
// Boxes. inverse = fl(1 / fl(d)) is right to 2 e of itself, -o / d made of it to 4 e, and b / d - o / d by
// one step, fused or not, to 4 e |t| + 7 e |o / d|; widened by 2^-20, as the far ends are, to 5 e |t| + 9 e
// |o / d|. The second term and more, 16 e (|o| + r 2^-10) / d, is in the constants `near` and `far`; the
// first, for near and far ends together, is less than the 16 e of the widening. What the doubles themselves
// are off by, 2^-50 of r + q, is well within r 2^-30. A direction's |d_a| < 2^-60 is taken for +-2^-60: on
// its way to a hit no ray moves by more than 2^-60 T along such an axis, T = 4 (r + q) < 2^9 r, and the
// constants, which give way by 2^30 r, hold all of [0, T] in the slab if the origin is within it but for that
// much.
//
// Triangles. With s = o - v0, L = `size` of the leaf (no component of an edge is above it), |s| the sum of
// s's components, D = 2^-24 (r + q) what s may be off by but for its own rounding e |s|, and d, v0, edges
// right to e: p = d x e2 is right to 8 e L, U = s.p to L (16 e |s| + 6 D), V = d.(s x e1) to the same, det =
// e1.p to 48 e L L, W = det - U - V to
//   E' = L (60 e (L + |s|) + 12 D),
// with fused steps or without. U, V, W are the edge functions of the test in double (raytrace/intersect.h)
// times d_kz, |d_kz| <= 1, which that test has right to 48 u m m, m <= L + |s| + D the farthest corner's
// distance, m <= 65 r; a verdict's doubts (raytrace/verdict.cpp) come on top, 16 f m + 216 u m m for points
// in doubt by f <= 2^-44 r. Together they are below 2^-38 r m. So
//   E = L (64 e (L + |s|) + 16 D), L >= 2^-16 r,
// which leaves E' that much and more, covers every difference between these floats and the doubles: if one of
// U, V, W is above E and another below -E, the doubles see edge functions of both signs: a miss. If all three
// are above E, or below -E, the doubles see one sign: a hit, unless t is out of range. t = N / det with
// N = e2.(s x e1) right to L E'; the doubles' mean of depths moves by 2 L times its weights' error. So t lies
// between (N - L E) / (det + E) and (N + L E) / (det - E), but for 2^-20 of itself.
#pragma once

#include <algorithm>

#include "raytrace/wide/tree.h"

namespace gnomon::raytrace {

struct WideRay {
  static constexpr float widening = 1.0f + 0x1p-20f;
  static constexpr float least_direction = 0x1p-60f;  ///< smaller ones are taken for this
  // By axis; the fourth means nothing.
  alignas(16) float origin[4], direction[4];
  // t of a plane at x along an axis: x inverse + near, and, widened, x far_inverse + far.
  alignas(16) float inverse[4], near[4], far_inverse[4], far[4];
  float t_min, t_max;                 ///< t_max: widened
  float surely_after, surely_before;  ///< t between these is in range
  float distance_error;               ///< 2^-20 (r + q)
  std::uint32_t octant;               ///< bit a: backwards along axis a

  /// t in the units of RayFrame.
  void limit(float t_above) { t_max = std::min(t_max, t_above * widening); }
};

}  // namespace gnomon::raytrace
