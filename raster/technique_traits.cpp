#include "raster/technique_traits.h"

namespace gnomon::raster {
namespace {

using enum MapOption;
using Options = MapOptionSet;
using Lights = LightTypeSet;

constexpr Lights every_light(LightType::directional, LightType::point, LightType::spot);
constexpr Lights sun(LightType::directional);

constexpr Options depth(bias, slope_bias, normal_offset, depth_format);
constexpr Options of_cube = depth | Options(receiver_plane, adaptive_bias, cull);
constexpr Options one_depth = of_cube | Options(snap);
// The filter compares with the receiver's plane by an option of its own.
constexpr Options averages =
    one_depth.without(Options(receiver_plane)) | Options(filter_plane, filter_samples);
constexpr Options pcf = averages | Options(filter_kernel, filter_radius);
constexpr Options pcss = averages | Options(blocker_samples, search_radius);
constexpr Options blurs = depth | Options(cull, blur_radius, mipmaps, snap);
constexpr Options bleeds = blurs | Options(bleeding_reduction);
constexpr Options csm = of_cube | Options(cascades, cascade_lambda, no_snap, cascade_fit, cascade_blend);

constexpr double planar = 1.0;  // the slope bias that leaves no acne on a plane

constexpr TechniqueTraits techniques[] = {
    {Technique::hard, "hard", MapContents::nearest_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar, one_depth},
    {Technique::pcf, "pcf", MapContents::nearest_depth, 1, ShadowTest::averaged, every_light,
     TexelShape::of_light, false, 0.0, pcf},
    {Technique::pcss, "pcss", MapContents::nearest_depth, 1, ShadowTest::averaged, every_light,
     TexelShape::of_light, true, 0.0, pcss},
    {Technique::vsm, "vsm", MapContents::moments, 2, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar, bleeds},
    {Technique::esm, "esm", MapContents::moments, 1, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar, blurs | Options(esm_exponent)},
    {Technique::evsm, "evsm", MapContents::moments, 4, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar, bleeds | Options(evsm_exponent, evsm_negative_exponent)},
    {Technique::msm, "msm", MapContents::moments, 4, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar, bleeds | Options(moment_bias)},
    {Technique::second_depth, "second-depth", MapContents::back_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar, one_depth.without(Options(cull))},
    {Technique::midpoint, "midpoint", MapContents::midpoint_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar, one_depth},
    {Technique::csm, "csm", MapContents::nearest_depth, 1, ShadowTest::single, sun, TexelShape::cascades,
     false, planar, csm},
    {Technique::lispsm, "lispsm", MapContents::nearest_depth, 1, ShadowTest::single, sun, TexelShape::warped,
     false, planar, one_depth},
    {Technique::cube, "cube", MapContents::nearest_depth, 1, ShadowTest::single, Lights(LightType::point),
     TexelShape::of_light, false, planar, of_cube},
    {Technique::izb,
     "izb",
     MapContents::pixels,
     0,
     ShadowTest::exact,
     every_light,
     TexelShape::of_light,
     false,
     planar,
     {}},
    {Technique::hybrid,
     "hybrid",
     MapContents::sheets,
     0,
     ShadowTest::exact,
     every_light,
     TexelShape::of_light,
     true,
     planar,
     {}}};

constexpr FilterKernelTraits kernels[] = {
    {FilterKernel::box, "box", Options(filter_samples)},
    {FilterKernel::hardware, "hardware", Options(filter_samples, filter_radius)},
    {FilterKernel::vogel, "vogel", {}},
    {FilterKernel::optimised, "optimised", Options(filter_samples)}};

template <class Enum, std::size_t N, class Traits>
constexpr bool in_order(const Traits (&table)[N], Enum Traits::*key) {
  for (std::size_t i = 0; i < N; ++i)
    if (static_cast<std::size_t>(table[i].*key) != i) return false;
  return true;
}
static_assert(in_order(techniques, &TechniqueTraits::technique), "rows are found by the enumeration's value");
static_assert(std::size(techniques) == static_cast<std::size_t>(Technique::hybrid) + 1);
static_assert(in_order(kernels, &FilterKernelTraits::kernel), "rows are found by the enumeration's value");

}  // namespace

std::span<const TechniqueTraits> all_technique_traits() {
  return techniques;
}

const TechniqueTraits& traits_of(Technique technique) {
  return techniques[static_cast<std::size_t>(technique)];
}

std::span<const FilterKernelTraits> all_filter_kernel_traits() {
  return kernels;
}

const FilterKernelTraits& traits_of(FilterKernel kernel) {
  return kernels[static_cast<std::size_t>(kernel)];
}

bool reads_option(const MapOptions& map, MapOption option) {
  if (!traits_of(map.technique).reads.has(option)) return false;
  return map.technique != Technique::pcf || !traits_of(map.filter.kernel).unread.has(option);
}

}  // namespace gnomon::raster
