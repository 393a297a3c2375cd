// Rays against solids (scene/shapes/solid.h), in double precision.
//
// Quadrics: the roots of a quadratic about the point nearest to the solid's centre, in the form that does not
// cancel (as spheres, raytrace/shapes/intersect.h); what lies between them is cut with the slab between the
// caps, so that body and caps always fit together. Tori: the quartic's roots lie between those of its
// derivatives, whose roots are found the same way down to a quadratic; the signs are those of the torus's own
// function. Implicit surfaces: interval arithmetic (raytrace/shapes/along_ray.h).
//
// A closed solid is crossed an even number of times by every line. A touch may count once, twice or not at
// all.
#pragma once

#include <vector>

#include "raytrace/shapes/intersect.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {

/// The first crossing in the ray's interval.
bool intersect_solid(const RayFrame& ray, const ShapeGeometry& solid, double& t);

/// All crossings of the whole line, ascending, in kernel units.
std::vector<double> solid_crossings(const RayFrame& ray, const ShapeGeometry& solid);

/// The ray in the solid's frame.
struct LocalRay {
  Vec3 origin, direction;
};
LocalRay local_ray(const RayFrame& ray, const ShapeGeometry& solid);

/// Where a line passes through a local box; empty when it misses. The box is closed.
Interval box_range(const LocalRay& ray, const Aabb& box);

/// A point near the surface put onto it, with a bound on its distance from it. Where f has no gradient (an
/// apex) no first-order bound exists, and a millionth of the box's diagonal is taken.
Vec3 solid_point(const ShapeGeometry& solid, const Vec3& near_surface, Vec3& error);

}  // namespace gnomon::raytrace
