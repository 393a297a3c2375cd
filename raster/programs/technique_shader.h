// Which shader of shaders/technique/ turns the map into visibility, and how it is specialised. Private to
// raster.
#pragma once

#include <string>
#include <vector>

#include "raster/options.h"
#include "scene/light_map/light_view.h"

namespace gnomon::raster {

/// How shade.frag is specialised: no branch on the technique remains in it.
struct TechniqueShader {
  std::string name = "hard";         ///< of the file in shaders/technique/, without .glsl
  std::vector<std::string> defines;  ///< "NAME" or "NAME value"
  auto operator<=>(const TechniqueShader&) const = default;
};
TechniqueShader technique_shader(const MapOptions& options, const Light& light);
/// What moments.frag is specialised by.
std::vector<std::string> moment_shader(const MapOptions& options, const Light& light, const LightView& view);

}  // namespace gnomon::raster
