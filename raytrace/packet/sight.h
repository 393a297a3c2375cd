// The world from an eye or a light, made ready for tiles of rays: the primitives seen from there, and cells
// where they pay; or, for an eye that is looked through once, nothing but its frame.
#pragma once

#include <span>

#include "raytrace/packet/cells.h"
#include "raytrace/packet/compact.h"
#include "scene/camera.h"

namespace gnomon::raytrace {

/// |u| and |v| of a point's rays stay below this: the bounds of raytrace/packet/seen_kernel.cpp.
inline constexpr double widest_slope = 1.5;

struct Sight {
  Seen seen;
  Cells cells;
  bool by_cells = false;
  bool by_blocks = false;  ///< an eye's: raytrace/packet/view_block.h. Neither: Seen::primitives are filled
};

/// Whether the world has a tree to walk and lengths that floats can hold.
bool packets_apply(const Structures& structures);

/// The light as a common origin or direction, for the hierarchy.
Seen seen_from(const Structures& structures, const Light& light);

/// How often an eye's picture will be traced: a sight that is kept may cost more to make.
enum class EyeUse { once, kept };

/// Cells, where there are any, are packets of 4 x 4 pixels.
Sight sight_of_eye(const Structures& structures, const View& view, EyeUse use = EyeUse::once);

/// Cells cover what the tiles hold. No tiles: the hierarchy. `wanted`: a flag for each tile, those without
/// are left out; empty: all are wanted.
Sight sight_of_light(const Structures& structures, const Light& light, std::span<const CompactTile> tiles,
                     std::span<const std::uint8_t> wanted = {});

/// The receiver lies on the only plane there is, and its ray beyond all that is finite: nothing shadows it.
bool is_beyond_all(const Structures& structures, const Sight& sight, const SurfacePoint& receiver);

/// Whether a light's sight that was made for other tiles serves these as well: cells cover them too.
bool covers(const Sight& sight, std::span<const CompactTile> tiles, std::span<const std::uint8_t> wanted);

}  // namespace gnomon::raytrace
