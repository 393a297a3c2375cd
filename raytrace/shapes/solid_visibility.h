// Whether a ray from a point that is known only within an error bound crosses a solid: surely, perhaps, or
// surely not. By interval arithmetic, for all origins within the bound at once.
#pragma once

#include "raytrace/shapes/solid.h"

namespace gnomon::raytrace {

enum class Intersects : std::uint8_t { no, perhaps, surely };

/// Crossings count in ray.t; from its end to `surely_out` they may count. `error`: of the origin, per axis of
/// the world. `source_normal`: for a ray that leaves this solid, its normal there on the side the ray leaves
/// to (else none). The start itself is no crossing, nor is that of a ray which starts on the solid within the error and
/// clearly leaves its surface there, to whichever side: a solid that is the same surface in another description.
Intersects intersects_solid(const RayFrame& ray, double surely_out, const Vec3& error,
                            const ShapeGeometry& solid, const Vec3* source_normal);

}  // namespace gnomon::raytrace
