// Which of the program's own shaders a technique reads.
#pragma once

#include <set>
#include <string>

#include "raster/options.h"

namespace gnomon::raster {

/// Its files of technique/ under whatever options, light and scene: of pcf one for each kernel.
std::set<std::string> technique_files(Technique technique);

/// Every file that may be compiled when a picture is drawn with it, those of technique_files() too.
std::set<std::string> files_read_by(Technique technique);

}  // namespace gnomon::raster
