// How far the drawn shadow's edges lie from the true ones.
#pragma once

#include "compare/comparison.h"

namespace gnomon::compare {

/// At every true shadow edge between two neighbouring compared pixels of one object, walks along the edge's
/// normal (the gradient of the truth over a 7x7 window) in half-pixel steps until the drawn shadow has its
/// edge there; edges that are not found within 64 pixels are missing features, not displaced edges, and are
/// left out. Offsets are > 0 where the drawn shadow is larger. Texel figures are distances between looked-up
/// map positions.
EdgeStats measure_edges(const raster::RasterFrame& drawn, const raster::LightRecord& record,
                        const Image<float>& truth, const Image<Label>& labels, const World& world);

/// Distance along the receiver between each pixel that the bias wrongly lights next to its caster
/// (peter_panning) and the occluder that should shadow it: t sin(angle between light and normal) for the
/// nearest occluder at t.
Detachment measure_detachment(const raytrace::Tracer& tracer, const Light& light,
                              const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels);

}  // namespace gnomon::compare
