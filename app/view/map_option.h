// One option of the shadow map by its command-line name: the very options of `gnomon compare`, with their
// ranges and messages, for the viewer's scripts.
#pragma once

#include <string>
#include <vector>

#include "raster/options.h"
#include "scene/expected.h"

namespace gnomon::app {

/// name "bias", value "0.5texel": as --bias 0.5texel. A flag takes on or off. Errors are ErrorKind::usage.
Expected<void> set_map_option(raster::MapOptions& map, const std::string& name, const std::string& value);

/// Whether there is such an option, and the names of all of them.
bool is_map_option(const std::string& name);
std::vector<std::string> map_option_names();

}  // namespace gnomon::app
