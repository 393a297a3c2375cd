// Settings of the map that each show one artifact, on whatever scene, and the constant bias on a slider of texels.
#pragma once

#include <span>
#include <string_view>

#include "raster/options.h"

namespace gnomon::app {

struct Preset {
  std::string_view title;
  std::string_view what;
  raster::MapOptions (*apply)(const raster::MapOptions&);
};
std::span<const Preset> presets();

/// The constant bias in texels of this width, and set so; a bias in world units stays in world units.
double bias_texels(const raster::Bias& bias, double constant_world, double texel_world);
void set_bias_texels(raster::Bias& bias, double texels, double texel_world);

}  // namespace gnomon::app
