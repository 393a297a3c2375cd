// The words of the command line for the rasterizer's and the scene's choices, as files and pages write them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raster/technique_traits.h"
#include "scene/scene.h"

namespace gnomon::compare {

using raster::technique_name;                                    ///< "hard", "second-depth"
std::string_view depth_format_name(raster::DepthFormat format);  ///< "d16", "d24", "d32f", "d32f-reversed"
std::string_view cull_name(raster::Cull cull);                   ///< "none", "front", "back"
/// "--slope-bias 1 --bias auto", "--receiver-plane --bias 0.002": what asks for a bias on the command line in place of what
/// asked for that of `drawn`. The automatic constant is asked for, too, because a scene or a lesson may ask for another.
std::string bias_arguments(const raster::Bias& bias, const raster::MapOptions& drawn = {});
/// What a bias has beside its constant: "slope bias 1", "normal offset 0.5 texels", "receiver plane", "adaptive bias".
std::vector<std::string> bias_parts(const raster::Bias& bias);
/// The same and the sides left out of the map, to go on with after the constant: ", slope bias 1, cull front".
std::string beside_constant(const raster::MapOptions& map);
/// "0.1.0", with the commit that the program was built from where that is known: "0.1.0+0123456789ab", and
/// ".changed" after it where files differed from the commit.
std::string_view program_version();

}  // namespace gnomon::compare
