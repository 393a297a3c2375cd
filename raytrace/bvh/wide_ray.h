// A ray as the wide tree sees it: floats that count from the tree's centre, and how far they may be off.
//
// Notation: e = 2^-24, u = 2^-53. d is the ray's direction, scaled so that its largest component is in [1/2, 1),
// o its origin from the centre. r = `reach`, q >= |o|, all in the maximum norm. No float here overflows, and
// none that underflows is missed, because 2^-26 <= r <= 2^30 and q <= 64 r. Other rays are refused, and traverse
// the plain way.
//
// Boxes. inverse = fl(1 / fl(d)) is right to 2 e of itself. So b inverse is right to 3 e |b / d|, and -o
// inverse made of rounded o to 4 e |o / d|. Their sum, fused or not, is right to 2 e more of either. Together
// that is less than 8 e (r + |o|) / |d|, for |b| <= r. The constants `near` and `far` give way by 16 e (r +
// |o|) / |d|. Their own rounding, and what the doubles themselves are off by, 2^-50 of r + q, is well within
// the rest. A direction's |d_a| < 2^-60 is taken for +-2^-60. On its way to a hit no ray moves by more than
// 2^-60 T along such an axis, T = 4 (r + q) < 2^9 r. The constants give way by 2^40 r. So they hold all of
// [0, T] in the slab if the origin is within it but for that much. The interval's ends are widened by 2^-20.
//
// Triangles. The test in double (raytrace/shapes/intersect.h) moves corners to the ray's origin and shears
// them so that the ray is the z axis. So do these floats, z being the direction's largest component. The
// depth is in units of t: t = s_z / d_z, x = s_x - d_x t, y likewise, s = v - o'. A leaf's corners v count
// from its anchor in steps of g, |v| <= X = 2^15 g; o' is the origin from there, S = |o'| + X. How far these
// are right:
// - v to g / 2 and, times g, to e X; o' to e (q + |o'|); s to g / 2 + e (q + 2 S)
// - d_x t is d_x / d_z times s_z, the factor, of at most 1, right to 5 e.
// - So x, with fused steps or without, is right to g + 2 e (q + 2 S) + 8 e S.
// - That is less than 12 e |o'| + 1.03 g + 2.75 e q + 2^-34 r, for 1.03 > 1 + 12 e 2^15.
// The last term holds what the doubles' own coordinates are off by. It also holds the bounds of a visibility
// (raytrace/precision/ambiguous_ray.cpp) in a point's place. All are below 2^-41 r. No anchor is farther than
// r from the centre, so that q <= |o'| + r and x is right to
//   f = `origin_error` |o'| + `corner_error` g + `coordinate_error`,
// which are 14.75 e, 1.03 and 2.875 e r.
//
// First, for all triangles of a leaf: let no component of an edge be above L >= 2^-16 r. The doubles may see
// edge functions of one sign, or fail to tell their signs for a visibility and pass the triangle's box. Then
// the axis passes within the corners' x and y, so none of these is above 2 L but for f. The edge functions
// are U, V, W = x_i y_j - x_j y_i. They are then right to 8 L f + 2 f f and, by rounding, 16 e (L + f)^2.
// Together that is less than 12 L f + 4 f f, less than f (13 L + 16 f). (An edge that is not that small has L
// <= 2 X <= 2 S.) If one of the three is above that and another below its negative, it is a miss.
//
// Then closer, for the few that are left: let no x or y be above m <= 2 S. An edge function is right to 4 m f
// + 2 f f and, by rounding, 4 e m m < 0.67 m f. Together that is less than E = f (5 m + 2 f). Two on either
// side of that are a miss, three on one side a hit in double, too, unless t is out of range. The doubles' t
// is a mean of the corners' t_i with weights U, V, W. The t_i are right to p = f / |d_z| and span R. Let det
// = U + V + W. Now bound |U t_0 + V t_1 + W t_2 - det t|. It is at most E (2 R + 6 p) for the weights and
// (|det| + 9 E) p for the t_i. Rounding, as e |t_i| <= e S / |d_z| < p / 12, adds less than (|det| + 12 E) p
// / 2. Together that is less than
//   D = 2 |det| p + E (2 R + 30 p),
// also where all weights are ambiguous, for t is between the corners' then. A hit's t is within D / |det| of
// the floats' own.
#pragma once

#include <algorithm>
#include <cfloat>

#include "raytrace/bvh/wide_tree.h"

namespace gnomon::raytrace {

struct WideRay {
  static constexpr float widening = 1.0f + 0x1p-20f;
  static constexpr float least_direction = 0x1p-60f;  ///< smaller ones are taken for this
  static constexpr float origin_error = 14.75f * 0x1p-24f;
  static constexpr float corner_error = 1.03f;  ///< in steps of a leaf
  // A number that was rounded to a float f is between down f - FLT_MIN and up f + FLT_MIN.
  static constexpr float up = 1.0f + FLT_EPSILON, down = 1.0f - FLT_EPSILON;

  // By axis; the fourth means nothing.
  alignas(16) float origin[4], direction[4], size[4];  ///< size: the direction's components without signs
  // t of a plane at x along an axis is between x inverse + near and x inverse + far.
  alignas(16) float inverse[4], near[4], far[4];
  float t_min, t_max;  ///< no hit is outside; t_max is widened and finite
  float least, most;   ///< the interval's ends to the nearest
  float coordinate_error;
  // A given t, of who limits the ray, counts from the given origin; t here from `start` on (raytrace/bvh/wide_instances.h).
  // It is a given t times `unit`, a power of two, less `start`; the other way round there are two factors near 1 / unit, one
  // for lower and one for upper bounds, which give way by more than the roundings. Where start is 0 they are 1 / unit.
  float unit, start, per_unit_below, per_unit_above;
  float plain_origin[3], plain_direction[3], kernel_t;  ///< as they are, for PlainTest alone; t's own scale
  std::uint32_t z;                                      ///< the axis of the direction's largest component
  std::uint32_t octant;                                 ///< bit a: backwards along axis a

  bool surely_starts_before(float t) const { return t > least * up + FLT_MIN; }
  bool surely_ends_after(float t) const { return t < std::min(most, FLT_MAX) * down - FLT_MIN; }

  /// A given t, in the units of RayFrame; of an instance's ray, of the frame in the world.
  void limit(float t_above) { t_max = std::min(t_max, t_above * unit * widening - start); }
  /// Bounds of a given t by bounds of t here.
  float given_below(float t) const { return (t + start) * per_unit_below; }
  float given_above(float t) const { return (t + start) * per_unit_above; }
  /// t in the units of this ray.
  void limit_here(float t_above) { t_max = std::min(t_max, t_above * widening); }
};

}  // namespace gnomon::raytrace
