// Settings of the map that each show one artifact, on whatever scene, and the constant bias on a slider of texels.
#pragma once

#include <span>
#include <string_view>

#include "compare/comparison.h"
#include "raster/options.h"

namespace gnomon::lab {

struct Preset {
  std::string_view title;
  std::string_view what;
  raster::MapOptions (*apply)(const raster::MapOptions&);
  std::span<const compare::Label> labels;  ///< of the pixels that show the artifact
  /// Above 0: when the comparison is there, the bias is raised until this share of the true shadow is lost.
  double lost_share = 0.0;
};
std::span<const Preset> presets();

/// The constant bias, in texels, at which a hard test of this map loses the share of the truly shadowed pixels; 0 where
/// none finds a caster.
double losing_bias_texels(const raster::LightRecord& drawn, const compare::LightComparison& light,
                          double share);
/// The share of the compared pixels that show the preset's artifact.
double shown_share(const Preset& preset, const compare::LightComparison& light);

/// The constant bias in texels of this width, and set so; a bias in world units stays in world units.
double bias_texels(const raster::Bias& bias, double constant_world, double texel_world);
void set_bias_texels(raster::Bias& bias, double texels, double texel_world);

}  // namespace gnomon::lab
