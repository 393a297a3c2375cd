// The filter of a technique as files and pages tell it: its kind, how far it reaches, and its parameters in words.
#pragma once

#include <string>
#include <string_view>

#include "raster/options.h"

namespace gnomon::compare {

/// "none", pcf's kernels, "penumbra" (pcss) or "moments".
std::string_view filter_kind(const raster::MapOptions& map);

/// How far from the receiver's place the filter can read, texels: half the width of its square; 0 for none.
/// Of pcss, the most. `level`: the mipmap level that is read; a texel of it averages 2^level, rounded up,
/// texels on a side, and its neighbours are read too.
double filter_reach_texels(const raster::MapOptions& map, double level = 0.0);

/// "moments, blur radius 2, ...": one line for a person; empty for none.
std::string filter_text(const raster::MapOptions& map);

}  // namespace gnomon::compare
