#include "app/view/map_rows.h"

#include <algorithm>

#include "app/filter_options.h"
#include "app/options.h"
#include "app/technique_options.h"
#include "raster/technique_traits.h"

namespace gnomon::app {

namespace {

using raster::MapOptions;

template <class Enum>
using NamedValues = std::span<const std::pair<std::string_view, Enum>>;

template <class Enum>
std::size_t place_among(NamedValues<Enum> all, Enum value) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.second == value; });
  return static_cast<std::size_t>(found - all.begin());
}

template <class Enum>
std::vector<std::string_view> names_among(NamedValues<Enum> all) {
  std::vector<std::string_view> names;
  for (const auto& [name, value] : all) names.push_back(name);
  return names;
}

/// Rows over one field of a part of the options; `part` and `field` are members.
template <auto part, auto field>
constexpr NumberRow number(double from, double to, std::string_view unit, bool logarithmic = false) {
  return {[](const MapOptions& map) { return map.*part.*field; },
          [](MapOptions& map, double value) { map.*part.*field = value; },
          from,
          to,
          unit,
          logarithmic};
}
template <auto part, auto field>
constexpr IntegerRow integer(int from, int to, std::string_view unit) {
  return {[](const MapOptions& map) { return map.*part.*field; },
          [](MapOptions& map, int value) { map.*part.*field = value; }, from, to, unit};
}
template <auto part, auto field>
constexpr SwitchRow flag() {
  return {[](const MapOptions& map) { return map.*part.*field; },
          [](MapOptions& map, bool on) { map.*part.*field = on; }};
}
/// `all`: the function that lists the values; `path`: the members that lead to the field.
template <auto all, auto... path>
constexpr ChoiceRow choice() {
  return {[](const MapOptions& map) { return place_among(all(), (map.*....*path)); },
          [](MapOptions& map, std::size_t place) { (map.*....*path) = all()[place].second; },
          [] { return names_among(all()); }};
}

constexpr auto bias = &MapOptions::bias;
constexpr auto filter = &MapOptions::filter;
constexpr auto cascades = &MapOptions::cascades;
using raster::Bias;
using raster::FilterOptions;

constexpr MapRow rows[] = {
    {"map-size", "Map size", RowGroup::map,
     IntegerRow{[](const MapOptions& map) { return map.size; },
                [](MapOptions& map, int value) { map.size = value; }, 16, 16384, "texels", true},
     "Texels on a side of the depth map.", "Twice the texels need half the bias.",
     "Less bias is enough, so shadows start closer to their casters."},
    {"depth-format", "Depth format", RowGroup::map, choice<&depth_formats, &MapOptions::depth_format>(),
     "The number format of the stored depth.", "Few bits round the depth: speckles that look like acne.",
     "None, but that coarser steps ask for more bias."},
    {"cull", "Leave out", RowGroup::map, choice<&culls, &MapOptions::cull>(),
     "The sides of surfaces that the map leaves out, as the light sees them.",
     "Without front faces, lit surfaces cannot shadow themselves; the back sides do.",
     "Without front faces a thin caster's shadow starts behind it, and open meshes leak."},
    {"snap", "Snap to steps", RowGroup::map,
     SwitchRow{[](const MapOptions& map) { return map.snap; },
               [](MapOptions& map, bool on) { map.snap = on; }},
     "The map grows by steps and moves by whole texels, so that shadows do not swim.",
     "None; its texels are larger.", "None; its texels are larger."},
    {"bias", "Constant bias", RowGroup::bias, BiasRow{},
     "How much nearer to the light the map's depth must be before it shadows.",
     "More takes acne away, from the faces that look at the light first.",
     "More makes it: the shadow starts that much behind its caster."},
    {"slope-bias", "Slope bias", RowGroup::bias, number<bias, &Bias::slope>(0.0, 4.0, "x slope"),
     "In multiples of the depth by which the surface falls over half a texel: 1 is what a plane needs.",
     "1 leaves none on a plane.", "Only as much as the slope asks for, but much at grazing light."},
    {"normal-offset", "Normal offset", RowGroup::bias,
     number<bias, &Bias::normal_offset_texels>(0.0, 4.0, "texels"),
     "Looks the map up from a point that is moved along the surface's normal.",
     "More takes it away, mostly where light grazes.",
     "Little along the light, but shadows grow thinner and move sideways."},
    {"receiver-plane", "Receiver plane", RowGroup::bias, flag<bias, &Bias::receiver_plane>(),
     "Compares with the receiver's own plane at the texel's centre.", "None is left on a plane.",
     "None on planes; at edges and folds the plane is the wrong one."},
    {"adaptive-bias", "Adaptive bias", RowGroup::bias, flag<bias, &Bias::adaptive>(),
     "As much as the receiver's plane rises up to the texel's centre (Dou et al. 2014).",
     "None is left on a plane.", "As little as the place in the texel allows."},
    {"filter-kernel", "Kernel", RowGroup::filter, choice<&filter_kernels, filter, &FilterOptions::kernel>(),
     "Which texels are compared with, and how they are weighed.",
     "A filter turns its stripes into grey; it does not take them away.", "Blurs the gap."},
    {"filter-radius", "Radius", RowGroup::filter,
     number<filter, &FilterOptions::radius_texels>(0.5, 16.0, "texels", true), "Half the kernel's width.",
     "A wider kernel needs more bias, unless it follows the receiver's plane.", "Blurs the gap."},
    {"filter-plane", "Follow the plane", RowGroup::filter, flag<filter, &FilterOptions::receiver_plane>(),
     "Compares each texel with the receiver's plane at its centre, not with the receiver's own depth.",
     "Off, slopes shadow themselves over the kernel's width.", "None."},
    {"filter-samples", "Samples", RowGroup::filter,
     integer<filter, &FilterOptions::samples>(1, 128, "lookups"), "Points of the filter.", "None.", "None."},
    {"blocker-samples", "Blocker samples", RowGroup::filter,
     integer<filter, &FilterOptions::blocker_samples>(1, 128, "lookups"),
     "Points of the search for what blocks the light.", "None.", "None."},
    {"search-radius", "Search radius", RowGroup::filter,
     number<filter, &FilterOptions::search_radius_texels>(1.0, 256.0, "texels", true),
     "The search goes no farther, however large the light.",
     "A wide search takes the receiver itself for a blocker.", "None."},
    {"blur-radius", "Blur radius", RowGroup::filter,
     integer<filter, &FilterOptions::blur_radius_texels>(0, 16, "texels"),
     "The map is averaged over 2 N + 1 texels each way.", "Averages it away.",
     "Light leaks in where the blur mixes near and far."},
    {"mipmaps", "Mipmaps", RowGroup::filter, flag<filter, &FilterOptions::mipmaps>(),
     "Pixels that cover several texels read their average.", "None.", "None."},
    {"bleeding-reduction", "Bleeding reduction", RowGroup::filter,
     number<filter, &FilterOptions::light_bleeding_reduction>(0.0, 0.9, "visibility"),
     "Visibility up to this is drawn black, the rest is stretched.", "More makes grey speckles black.",
     "Takes away the light that bleeds into shadows, and narrows penumbrae."},
    {"esm-exponent", "Exponent", RowGroup::filter,
     number<filter, &FilterOptions::esm_exponent>(1.0, 80.0, "per range", true), "c in exp(c z).",
     "A large one brings it back.", "A small one lets light through near the caster."},
    {"evsm-exponent", "Exponent", RowGroup::filter,
     number<filter, &FilterOptions::evsm_positive_exponent>(1.0, 40.0, "per half range", true),
     "p in exp(p z).", "None.", "A larger one leaks less."},
    {"evsm-negative-exponent", "Negative exponent", RowGroup::filter,
     number<filter, &FilterOptions::evsm_negative_exponent>(0.5, 40.0, "per half range", true),
     "n in -exp(-n z).", "None.", "A larger one leaks less behind near casters."},
    {"moment-bias", "Moment bias", RowGroup::filter,
     number<filter, &FilterOptions::moment_bias>(0.0, 1e-4, "share"),
     "Share of a fixed distribution mixed into the moments against rounding.",
     "Takes away rounding's speckles.", "More leaks more light."},
    {"cascades", "Cascades", RowGroup::cascades, integer<cascades, &CascadeOptions::count>(1, 6, ""),
     "Slices of the view, one map each.", "Smaller texels near the eye need less bias there.",
     "Less near the eye."},
    {"cascade-lambda", "Split", RowGroup::cascades,
     number<cascades, &CascadeOptions::lambda>(0.0, 1.0, "share"),
     "0 splits the view's depth evenly, 1 evenly in its logarithm.",
     "More gives the near slices smaller texels.", "Less near the eye."},
    {"cascade-blend", "Blend", RowGroup::cascades,
     number<cascades, &CascadeOptions::blend>(0.0, 0.5, "share"),
     "Along the border of a slice, over this share of its width, its test is mixed with the next one's.",
     "None.", "None."},
    {"no-snap", "Snap to texels", RowGroup::cascades, flag<cascades, &CascadeOptions::snap>(),
     "Moves each cascade by whole texels, so that shadows do not swim.", "None.", "None."},
    {"cascade-fit", "Fit to surfaces", RowGroup::cascades, flag<cascades, &CascadeOptions::fit_samples>(),
     "Fits splits and cascades to the surfaces that the camera sees; they then swim.",
     "Smaller texels need less bias.", "Less."},
};

/// What is shown does not depend on what another preset showed before: the size is the default one again.
MapOptions hard_with(const MapOptions& map, double bias_texels, double slope) {
  MapOptions out = map;
  out.size = MapOptions{}.size;
  const bool hard = raster::traits_of(map.technique).test == raster::ShadowTest::single;
  if (!hard) out.technique = raster::Technique::hard;
  out.cull = raster::Cull::none;
  out.bias = Bias{.constant = bias_texels, .unit = raster::BiasUnit::texel, .slope = slope};
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

std::span<const MapRow> map_rows() {
  return rows;
}

bool is_read(const MapRow& row, const MapOptions& map) {
  return technique_reads(row.option, map);
}

double bias_texels(const Bias& bias, double constant_world, double texel_world) {
  if (bias.unit == raster::BiasUnit::texel) return bias.constant;
  return texel_world > 0.0 ? constant_world / texel_world : 0.0;
}

void set_bias_texels(Bias& bias, double texels, double texel_world) {
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
