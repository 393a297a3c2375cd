// What many single rays are answered by (raytrace/bvh/wide_tree.h), for those who measure it.
#pragma once

#include "raytrace/tracer.h"

namespace gnomon::raytrace {

/// Makes it now; else it is made when enough rays have come. Accel::bvh alone has it. Any number of threads may
/// ask, and cast rays meanwhile.
void prepare_single_rays(const Tracer& tracer);

/// Bytes that it holds; 0: it has not been made.
std::uint64_t single_ray_bytes(const Tracer& tracer);

/// As Tracer::closest_hit() and occluded() with counts, but through what single rays go through when it has been
/// made: boxes of children and triangles of leaves tested in floats, and planes.
std::optional<Hit> counted_closest_hit(const Tracer& tracer, const Ray& ray, WorkCounts& work);
bool counted_occluded(const Tracer& tracer, const Ray& ray, WorkCounts& work);

}  // namespace gnomon::raytrace
