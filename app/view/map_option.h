// One option of the shadow map by its command-line name: the very options of `gnomon compare`, with their
// ranges and messages, for the viewer's scripts.
#pragma once

#include <string>

#include "raster/options.h"
#include "scene/expected.h"

namespace gnomon::app {

/// name "bias", value "0.5texel": as --bias 0.5texel. A flag takes on or off. Errors are ErrorKind::usage.
Expected<void> set_map_option(raster::MapOptions& map, const std::string& name, const std::string& value);

/// Whether there is such an option; map_setting_names() (setting.h) has all of them.
bool is_map_option(const std::string& name);

}  // namespace gnomon::app
