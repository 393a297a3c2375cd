// One renderer that draws with the shaders of one folder after another: whatever they do not replace is linked once.
#pragma once

#include <string>

#include "raster/renderer.h"

namespace gnomon::raster {

/// Names, in a process's environment, a folder of shader folders, which stand in turn in place of --shader-dir. For each of them
/// `compare` writes --aov and `shaders --call` writes --json into a folder of its own, and nothing else.
inline constexpr const char* each_folder_variable = "GNOMON_EACH_SHADER_FOLDER";

/// From the next frame on the files of this folder, and no others, take the place of the program's own. Errors as those of
/// Renderer::create. The renderer is one that Renderer::create made.
Expected<void> use_shaders(Renderer& renderer, const std::string& folder);

}  // namespace gnomon::raster
