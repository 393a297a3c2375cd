// The options of the techniques that average: kernels, radii, samples, exponents.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "raster/options.h"

namespace CLI {
class App;
}

namespace gnomon::app {

void add_filter_options(CLI::App& command, raster::FilterOptions& filter);

/// The values of --filter-kernel.
std::span<const std::pair<std::string_view, raster::FilterKernel>> filter_kernels();

/// " --filter-radius 2.5 ...": every option that the technique reads and that is not at its default, to type
/// again.
std::string filter_options_text(const raster::MapOptions& map);

}  // namespace gnomon::app
