// Triangles that reach absurdly far, as one with a broken corner does: named, and left out of what lengths are measured by.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace gnomon::judge {

/// Returns the diagonal of the box of what the picture shows; 0 of nothing.
double seen_diagonal(const raytrace::RayTracedFrame& traced);

/// Says how many triangles reach more than 100 times as far as 99 in 100 do, where they are few and the picture shows none of
/// that.
std::vector<std::string> far_triangle_notes(const World& world, const raytrace::RayTracedFrame& traced);

}  // namespace gnomon::judge
