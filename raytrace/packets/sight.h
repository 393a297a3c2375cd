// The world from an eye or a light, made ready for tiles of rays: of an eye nothing but its frame, of a light
// bins where they pay, else the primitives seen from there.
#pragma once

#include <span>

#include "raytrace/packets/light_bins.h"
#include "raytrace/packets/quantised_tile.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// |u| and |v| of a point's rays stay below this: the bounds of raytrace/packets/edge_setup_kernel.cpp.
inline constexpr double widest_slope = 1.5;

struct Sight {
  EdgeSetup setup;  ///< its primitives are filled where the rays do not go by bins
  LightBins bins;
  bool by_bins = false;
};

/// Whether the world has a tree to traverse and lengths that floats can hold.
bool packets_apply(const Tracer& tracer);

/// The light as a common origin or direction, for the hierarchy.
EdgeSetup edge_setup_from(const Structures& structures, const Light& light);

/// Whether the eye's rays go by blocks (raytrace/packets/view_block.h): packets apply, and one frame holds
/// the whole field of view.
bool blocks_apply(const Tracer& tracer, const View& view);

/// The eye's frame, for such a view.
EdgeSetup edge_setup_of_eye(const Tracer& tracer, const View& view);

/// Bins cover what the tiles hold. No tiles: the hierarchy. `wanted`: a flag for each tile, those without
/// are left out; empty: all are wanted.
Sight sight_of_light(const Tracer& tracer, const Light& light, std::span<const QuantisedTile> tiles,
                     std::span<const std::uint8_t> wanted = {});

/// The receiver lies on the only plane there is, and its ray beyond all that is finite: nothing shadows it.
bool is_beyond_all(const Structures& structures, const Sight& sight, const SurfacePoint& receiver);

/// Whether a light's sight that was made for other tiles serves these as well: bins cover them too.
bool covers(const Sight& sight, std::span<const QuantisedTile> tiles, std::span<const std::uint8_t> wanted);

}  // namespace gnomon::raytrace
