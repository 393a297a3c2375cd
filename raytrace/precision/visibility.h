// Visibility of a light's centre with the error bound's ambiguity made visible. Every test is made for the
// whole box of origins that the surface point's error bound allows: a primitive hit from all of them is a
// sure hit, one hit from some only is ambiguous. A sure hit outweighs any number of ambiguous ones, so closed
// meshes cast no uncertain shadow inside their outline.
#pragma once

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// Positions in leaf order; nullptr: all.
using LeavesAmong = const std::span<const std::uint32_t>*;

/// `ray` is Tracer::shadow_ray of the point. `among`: whatever else is there, but planes, is surely missed.
/// `last`: as Tracer::centre_visibility has it.
PointVisibility point_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                 LeavesAmong among = nullptr, LastBlocker* last = nullptr);

/// The same without ambiguity: what the bounds leave open is decided by exact predicates (exact_shadow.h
/// there).
PointVisibility certified_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                     const Light& light, LeavesAmong among = nullptr,
                                     LastBlocker* last = nullptr);

}  // namespace gnomon::raytrace
