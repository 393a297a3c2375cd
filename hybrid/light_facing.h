// What a light's place alone decides about every triangle: which way it faces, and which of its edges can be
// the boundary of a sheet (raytrace/sheets/sheets.h). Made once per light; the map's texels then ask nothing but
// where edges lie. Rounding only ever adds boundary.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/sheets/sheets.h"

namespace gnomon::hybrid {

/// Coordinates that the bounds hold for, and how far rounding moves a point's place in light space.
struct WorldBounds {
  double reach = 0.0;           ///< world units: no coordinate of a vertex or receiver is larger
  double position_error = 0.0;  ///< world units, of each component relative to the view's origin
};
WorldBounds world_bounds(const World& world, const LightView& view);

struct TriangleFacing {
  static constexpr std::uint8_t whole = 8;  ///< edge-on, degenerate or alpha-masked: boundary everywhere
  std::int8_t facing = 0;                   ///< towards the light 1, away -1, too close to say 0
  std::uint8_t boundary = 0;                ///< bit k: edge k (corners k, k + 1) is no inner edge of a sheet
};

/// One per triangle of the world. In parallel; the same for any number of threads.
std::vector<TriangleFacing> find_facing(const World& world, const raytrace::Topology& topology,
                                        const LightView& view, const WorldBounds& bounds);

}  // namespace gnomon::hybrid
