#include "lab/view/state/presets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "raster/technique_traits.h"

namespace gnomon::lab {

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

using compare::Label;
constexpr Label acne_labels[] = {Label::acne, Label::stored_depth};
constexpr Label panning_labels[] = {Label::peter_panning};
constexpr Label aliasing_labels[] = {Label::aliasing, Label::missed_feature, Label::false_feature};
constexpr Label leak_labels[] = {Label::light_leak};

constexpr Preset preset_table[] = {
    {"Show acne", "no bias at all: surfaces shadow themselves, in stripes that follow the texels",
     [](const MapOptions& map) { return hard_with(map, 0.0, 0.0); }, acne_labels},
    {"Show peter-panning", "a bias that loses a third of the shadow: shadows come loose from what casts them",
     [](const MapOptions& map) { return hard_with(map, 8.0, 0.0); }, panning_labels, 1.0 / 3.0},
    {"Show aliasing", "a map of 128 texels with the bias that it needs: edges are stairs",
     [](const MapOptions& map) {
       MapOptions out = hard_with(map, raster::automatic_bias_texels, 1.0);
       out.size = 128;
       return out;
     },
     aliasing_labels},
    {"Show a leak", "an exponential map with too small an exponent: light gets through behind near casters",
     [](const MapOptions& map) {
       MapOptions out = map;
       out.technique = raster::Technique::esm;
       out.size = MapOptions{}.size;
       out.cull = raster::Cull::none;
       out.bias = MapOptions{}.bias;
       out.filter.esm_exponent = 10.0;
       return out;
     },
     leak_labels},
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

double losing_bias_texels(const raster::LightRecord& drawn, const compare::LightComparison& light,
                          double share) {
  std::vector<float> gaps;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    const float gap = drawn.gap.data[i];
    if (compare::is_compared(light.labels.data[i]) && light.rungs[0].data[i] < 0.5f && gap > 0.0f &&
        std::isfinite(gap))
      gaps.push_back(gap);
  }
  if (gaps.empty() || !(drawn.texel_world > 0.0)) return 0.0;
  const auto at = gaps.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(gaps.size() - 1));
  std::nth_element(gaps.begin(), at, gaps.end());
  return double{*at} / drawn.texel_world;
}

double shown_share(const Preset& preset, const compare::LightComparison& light) {
  std::uint64_t count = 0;
  for (const Label label : preset.labels) count += light.classes[static_cast<std::size_t>(label) - 1];
  return static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(1, light.pixels.compared));
}

std::span<const Preset> presets() {
  return preset_table;
}

}  // namespace gnomon::lab
