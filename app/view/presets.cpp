#include "app/view/presets.h"

#include "raster/technique_traits.h"

namespace gnomon::app {

namespace {

using raster::MapOptions;

/// What is shown does not depend on what another preset showed before: the size is the default one again.
MapOptions hard_with(const MapOptions& map, double bias_texels, double slope) {
  MapOptions out = map;
  out.size = MapOptions{}.size;
  const bool hard = raster::traits_of(map.technique).test == raster::ShadowTest::single;
  if (!hard) out.technique = raster::Technique::hard;
  out.cull = raster::Cull::none;
  out.bias = raster::Bias{.constant = bias_texels, .unit = raster::BiasUnit::texel, .slope = slope};
  return out;
}

constexpr Preset preset_table[] = {
    {"Show acne", "no bias at all: surfaces shadow themselves, in stripes that follow the texels",
     [](const MapOptions& map) { return hard_with(map, 0.0, 0.0); }},
    {"Show peter-panning", "a bias of eight texels: shadows come loose from what casts them",
     [](const MapOptions& map) { return hard_with(map, 8.0, 0.0); }},
    {"Show aliasing", "a map of 128 texels with the bias that it needs: edges are stairs",
     [](const MapOptions& map) {
       MapOptions out = hard_with(map, raster::automatic_bias_texels, 1.0);
       out.size = 128;
       return out;
     }},
    {"Show a leak", "an exponential map with too small an exponent: light gets through behind near casters",
     [](const MapOptions& map) {
       MapOptions out = map;
       out.technique = raster::Technique::esm;
       out.size = MapOptions{}.size;
       out.cull = raster::Cull::none;
       out.bias = MapOptions{}.bias;
       out.filter.esm_exponent = 10.0;
       return out;
     }},
};

}  // namespace

double bias_texels(const raster::Bias& bias, double constant_world, double texel_world) {
  if (bias.unit == raster::BiasUnit::texel) return bias.constant;
  return texel_world > 0.0 ? constant_world / texel_world : 0.0;
}

void set_bias_texels(raster::Bias& bias, double texels, double texel_world) {
  if (bias.unit == raster::BiasUnit::world) {
    bias.constant = texels * texel_world;
  } else {
    bias.constant = texels;
    bias.unit = raster::BiasUnit::texel;
  }
}

std::span<const Preset> presets() {
  return preset_table;
}

}  // namespace gnomon::app
