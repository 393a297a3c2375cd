// The rasterizer's choices and the program's version in the words of files and pages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raster/settings.h"

namespace gnomon::compare {

using raster::bias_arguments;
using raster::cull_name;
using raster::depth_format_name;
using raster::technique_name;

/// "slope bias 1", "blur radius 2 texels", "receiver plane", "no mipmaps": one setting and its value.
std::string setting_words(const raster::MapSetting& setting, const raster::MapOptions& map);
/// What a bias has beside its constant: "slope bias 1", "normal offset 0.5 texels", "receiver plane", "adaptive bias".
std::vector<std::string> bias_parts(const raster::Bias& bias);
/// Adds the sides left out of the map to what a bias has beside its constant, to go on with after it: ", slope bias 1, cull
/// front".
std::string beside_constant(const raster::MapOptions& map);
/// "0.1.0", with the commit that the program was built from where that is known: "0.1.0+0123456789ab", and
/// ".changed" after it where files differed from the commit.
std::string_view program_version();

}  // namespace gnomon::compare
