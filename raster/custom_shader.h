// Whether files of a shader folder decide the visibility that is drawn. Private to raster.
#pragma once

#include <optional>

#include "raster/frame.h"
#include "raster/shader_folder.h"

namespace gnomon::raster {

/// The files of the folder that stand in for the technique's own, for what it is given (shade.frag, the test of depths
/// in gap.glsl, the lookup in light.glsl and light_map.glsl, what fills the maps of moments) or for the irregular
/// z-buffer's; none where all of these are the program's.
std::optional<CustomShader> custom_shader(const ShaderFolder& folder, const MapOptions& map,
                                          const Light& light);

}  // namespace gnomon::raster
