// Which technique reads which option, by raster/technique_traits.h: --help says whose an option is, and an
// option that the technique does not read is refused rather than ignored.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/options.h"
#include "scene/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Options that not every technique reads, without "--".
std::vector<std::string_view> technique_options();

/// Whether the options' technique, with their filter kernel, reads the option; true for any option not of the
/// table.
bool technique_reads(std::string_view option, const raster::MapOptions& map);
/// With any of the filter kernels.
bool technique_reads(std::string_view option, raster::Technique technique);

/// "pcf (box, vogel, optimised)", "all but izb, hybrid": who reads an option of the table.
std::string readers_of(std::string_view option);

/// Error (usage) when none of the techniques, with any of the kernels, reads the option.
Expected<void> check_read(std::string_view option, std::span<const raster::Technique> techniques,
                          std::span<const raster::FilterKernel> kernels);

/// Puts the readers before the help of each option of the table.
void name_readers(CLI::App& command);

/// When all is parsed: throws CLI::ValidationError for the first option on the command line that the
/// technique does not read. A bias of any kind takes the place of the default's slope.
void finish_map_options(const CLI::App& command, raster::MapOptions& map);

}  // namespace gnomon::app
