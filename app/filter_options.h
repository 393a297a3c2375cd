// The options of the techniques that average: kernels, radii, samples, exponents.
#pragma once

#include <string>

#include "raster/options.h"

namespace CLI {
class App;
}

namespace gnomon::app {

void add_filter_options(CLI::App& command, raster::FilterOptions& filter);

/// " --filter-radius 2.5 ...": every option that is not at its default, to type again.
std::string filter_options_text(const raster::FilterOptions& filter);

}  // namespace gnomon::app
