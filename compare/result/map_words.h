// The shadow map, its bias and its filter in words: one text for the terminal, the page and result.json. Of another renderer's
// map they say what the capture says, and nothing of Gnomon's own settings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "raster/settings.h"

namespace gnomon::compare {

/// "d32f"; of another renderer's map what its texels hold: "depths", "distances", "linear depths", "moments".
std::string stored_text(const raster::LightRecord& record);

/// "0.02 (0.5 texels; a texel is 0.04 wide)". Of another renderer's constant that is no single length: "0.0005 of stored depth
/// (0.06 world units at 10 from the light, 0.96 at 40)".
std::string constant_text(const raster::LightRecord& record, double texel_world);
/// "0.06 world units at 10 from the light, 0.96 at 40": so many stored numbers at the nearest and the farthest receiver. Empty
/// where they are one length.
std::string two_lengths(const std::array<raster::UnitAt, 2>& units, double stored);

/// ", d32f, bias 0.02 (0.5 texels; a texel is 0.04 wide), slope bias 1": what follows the map's size. Of several lights the
/// constant is left out, which is each light's own: `light` is then null.
std::string map_details(const Comparison& comparison, const LightComparison* light);

/// The filter's settings that are known to have drawn: all that the technique reads; of another renderer's those of its capture.
std::vector<const raster::MapSetting*> filter_settings(const raster::RasterFrame& drawn);
/// "none", the kernel, "penumbra" or "moments"; "pcf" of another renderer, whose kernel no capture says.
std::string_view shown_filter_kind(const raster::RasterFrame& drawn);
/// "moments, blur radius 2, ...": one line for a person; empty for none.
std::string filter_text(const raster::RasterFrame& drawn);

}  // namespace gnomon::compare
