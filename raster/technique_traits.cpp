#include "raster/technique_traits.h"

namespace gnomon::raster {
namespace {

using Lights = LightTypeSet;

constexpr Lights every_light(LightType::directional, LightType::point, LightType::spot);
constexpr Lights sun(LightType::directional);

constexpr double planar = 1.0;  // the slope bias that leaves no acne on a plane

constexpr TechniqueTraits techniques[] = {
    {Technique::hard, "hard", MapContents::nearest_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar},
    {Technique::pcf, "pcf", MapContents::nearest_depth, 1, ShadowTest::averaged, every_light,
     TexelShape::of_light, false, 0.0},
    {Technique::pcss, "pcss", MapContents::nearest_depth, 1, ShadowTest::averaged, every_light,
     TexelShape::of_light, true, 0.0},
    {Technique::vsm, "vsm", MapContents::moments, 2, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar},
    {Technique::esm, "esm", MapContents::moments, 1, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar},
    {Technique::evsm, "evsm", MapContents::moments, 4, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar},
    {Technique::msm, "msm", MapContents::moments, 4, ShadowTest::moments, every_light, TexelShape::of_light,
     false, planar},
    {Technique::second_depth, "second-depth", MapContents::back_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar},
    {Technique::midpoint, "midpoint", MapContents::midpoint_depth, 1, ShadowTest::single, every_light,
     TexelShape::of_light, false, planar},
    {Technique::csm, "csm", MapContents::nearest_depth, 1, ShadowTest::single, sun, TexelShape::cascades,
     false, planar},
    {Technique::lispsm, "lispsm", MapContents::nearest_depth, 1, ShadowTest::single, sun, TexelShape::warped,
     false, planar},
    {Technique::cube, "cube", MapContents::nearest_depth, 1, ShadowTest::single, Lights(LightType::point),
     TexelShape::of_light, false, planar},
    {Technique::izb, "izb", MapContents::pixels, 0, ShadowTest::exact, every_light, TexelShape::of_light,
     false, planar},
    {Technique::hybrid, "hybrid", MapContents::sheets, 0, ShadowTest::exact, every_light,
     TexelShape::of_light, true, planar}};

constexpr FilterKernelTraits kernels[] = {{FilterKernel::box, "box"},
                                          {FilterKernel::hardware, "hardware"},
                                          {FilterKernel::vogel, "vogel"},
                                          {FilterKernel::optimised, "optimised"}};

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

}  // namespace gnomon::raster
