// Oracles in rational numbers (GMP): nothing is rounded, and the formulas are the textbooks' (Moeller and
// Trumbore), other ones than the exact predicates of raytrace/precision/ use.
#pragma once

#include <array>

#include "raytrace/tracer.h"

namespace gnomon::verify {

struct RationalTriangle {
  bool meets = false;   ///< the line meets the closed triangle; never when it lies in its plane
  bool ahead = false;   ///< t > 0
  double inside = 0.0;  ///< the smallest barycentric weight, rounded
  double slope = 0.0;   ///< normal (twice the area long) times direction, rounded
};
RationalTriangle rational_triangle(const Vec3& origin, const Vec3& direction,
                                   const std::array<Vec3, 3>& corners);

/// The sign of one triangle's t minus another's on a line that meets both.
int rational_order(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& one,
                   const std::array<Vec3, 3>& other);

/// Whether any primitive of the world but the point's own triangle or plane meets the open segment from the
/// point to a hard light. Of a directional one it is the ray to infinity. Spheres and planes as they are given.
/// nullopt: the point lies on no triangle and no plane, or only a surface with holes or a solid may block the segment.
std::optional<bool> rationally_shadowed(const World& world, const raytrace::SurfacePoint& point,
                                        const Light& light);

/// Whether any triangle of the world but the point's own meets the open segment from the point, the mean of
/// its triangle's corners with its weights, to `light`. Doubles decide first where they are far from a tie.
bool rationally_shadowed(const World& world, const raytrace::SurfacePoint& point, const Vec3& light);

}  // namespace gnomon::verify
