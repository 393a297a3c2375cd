// The smooth body that a mesh of flat triangles stands for, as its vertices' normals tell it. Here are the interpolated
// normal, and the place above a triangle that J. Hanika starts shadow rays from ("Hacking the shadow terminator", Ray
// Tracing Gems II, chapter 4, 2021). So light ends where the body's own shading does and not with the facets.
#pragma once

#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Interpolated and normalised, on the side of the point's geometric normal; the geometric normal where the
/// mesh has none.
Vec3 shading_normal(const World& world, const SurfacePoint& point);

/// Whether the normals of a triangle's corners lie on the side of `normal`, its geometric one, and see `direction` as it
/// does. Each must do so by more than `margin` (cosines). Then shading_normal() does so at every point of it.
bool corners_see_alike(const World& world, std::uint32_t primitive, const Vec3& normal, const Vec3& direction,
                       double margin);

/// The point of a triangle brought onto its smooth body, with the shading normal for its geometric one. It is projected
/// onto the planes through the corners square to their normals, where it lies below them. The three places are mixed by
/// its own weights (Hanika 2021). Corners stay where they are, and so does what has no normals of its own.
SurfacePoint on_smooth_body(const World& world, const SurfacePoint& point);

}  // namespace gnomon::raytrace
