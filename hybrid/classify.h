// A picture tile's receivers against the sheets, eight at a time, from the compact floats: the texel and the
// reciprocal depth of each in double, with all that the floats' rounding can do added to the errors. What floats leave
// open is for LightSheets::at.
#pragma once

#include "hybrid/light_sheets.h"
#include "raytrace/quantised_tile.h"

namespace gnomon::hybrid {

using raytrace::LaneMask;

/// Of the receivers that are there: bits per packet, each receiver in one of them.
struct TileClasses {
  LaneMask unreached;  ///< facing away from the light
  LaneMask lit, shadowed;
  LaneMask ambiguous;  ///< facing it, and the sheets cannot tell
  LaneMask open;       ///< to be asked in double: whether it faces the light, or what the sheets say
};

/// No spot lights: a cone is not looked at.
void classify_tile(const LightSheets& sheets, const Light& light, const raytrace::QuantisedTile& tile,
                   TileClasses& out);

}  // namespace gnomon::hybrid
