// The command line's options of the shadow map, made from raster/settings.h. --help says whose an option is. An option
// that the technique does not read is refused rather than ignored.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/settings.h"
#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// --map-size, --technique, the biases, --depth-format, --cull, the filters, the cascades, --snap.
void add_map_options(CLI::App& command, raster::MapOptions& map);
/// One of them.
void add_map_option(CLI::App& command, std::string_view name, raster::MapOptions& map);

/// The names (without "--") of all of them.
std::vector<std::string> map_setting_names();
/// The values of --technique.
std::vector<std::string> technique_names();

/// "pcf (box, vogel, optimised)", "all but izb, hybrid": who reads the setting.
std::string readers_text(const raster::MapSetting& setting);

/// Error (usage) when none of the techniques, with any of the kernels, reads the option. `option`: any, without "--".
Expected<void> check_read(std::string_view option, std::span<const raster::Technique> techniques,
                          std::span<const raster::FilterKernel> kernels);

/// When all is parsed: throws CLI::ValidationError for the first option on the command line that the
/// technique does not read. Where a technique was given again, such options are the former one's, and are set back.
/// A bias of any kind takes the place of the default's slope.
void finish_map_options(const CLI::App& command, raster::MapOptions& map);

}  // namespace gnomon::app
