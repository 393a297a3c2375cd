#include "raster/technique_traits.h"

#include "raster/frame.h"

namespace gnomon::raster {

// Each in the file of its pass, those without one in passes/technique.cpp.
extern const TechniqueDrawing hard_drawing, pcf_drawing, pcss_drawing, csm_drawing, lispsm_drawing,
    hybrid_drawing, rays_drawing;
extern const TechniqueDrawing vsm_drawing, esm_drawing, evsm_drawing, msm_drawing;
extern const TechniqueDrawing midpoint_drawing;
extern const TechniqueDrawing izb_drawing;

namespace {

constexpr LightTypeSet sun(LightType::directional);

constexpr TechniqueTraits moments_of(Technique technique, std::string_view name,
                                     const TechniqueDrawing* drawing, int floats_per_texel) {
  return {.technique = technique,
          .name = name,
          .drawing = drawing,
          .contents = MapContents::moments,
          .floats_per_texel = floats_per_texel,
          .test = ShadowTest::moments,
          .filter = EdgeFilter::moments};
}

constexpr TechniqueTraits techniques[] = {
    {.technique = Technique::hard, .name = "hard", .drawing = &hard_drawing},
    {.technique = Technique::pcf,
     .name = "pcf",
     .drawing = &pcf_drawing,
     .test = ShadowTest::averaged,
     .filter = EdgeFilter::kernel,
     .default_slope_bias = 0.0},
    {.technique = Technique::pcss,
     .name = "pcss",
     .drawing = &pcss_drawing,
     .test = ShadowTest::averaged,
     .filter = EdgeFilter::penumbra,
     .soft = true,
     .default_slope_bias = 0.0},
    moments_of(Technique::vsm, "vsm", &vsm_drawing, 2),
    moments_of(Technique::esm, "esm", &esm_drawing, 1),
    moments_of(Technique::evsm, "evsm", &evsm_drawing, 4),
    moments_of(Technique::msm, "msm", &msm_drawing, 4),
    {.technique = Technique::second_depth,
     .name = "second-depth",
     .drawing = &hard_drawing,
     .contents = MapContents::back_depth},
    {.technique = Technique::midpoint,
     .name = "midpoint",
     .drawing = &midpoint_drawing,
     .contents = MapContents::midpoint_depth},
    {.technique = Technique::csm,
     .name = "csm",
     .drawing = &csm_drawing,
     .lights = sun,
     .texels = TexelShape::cascades},
    {.technique = Technique::lispsm,
     .name = "lispsm",
     .drawing = &lispsm_drawing,
     .lights = sun,
     .texels = TexelShape::warped},
    {.technique = Technique::cube,
     .name = "cube",
     .drawing = &hard_drawing,
     .lights = LightTypeSet(LightType::point)},
    {.technique = Technique::izb,
     .name = "izb",
     .drawing = &izb_drawing,
     .contents = MapContents::pixels,
     .floats_per_texel = 0,
     .test = ShadowTest::exact},
    {.technique = Technique::hybrid,
     .name = "hybrid",
     .drawing = &hybrid_drawing,
     .contents = MapContents::sheets,
     .floats_per_texel = 0,
     .test = ShadowTest::exact,
     .soft = true},
    {.technique = Technique::rays,
     .name = "rays",
     .drawing = &rays_drawing,
     .contents = MapContents::nothing,
     .floats_per_texel = 0,
     .test = ShadowTest::sampled,
     .soft = true}};

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
static_assert(std::size(techniques) == static_cast<std::size_t>(Technique::rays) + 1);
static_assert(in_order(kernels, &FilterKernelTraits::kernel), "rows are found by the enumeration's value");

}  // namespace

std::span<const TechniqueTraits> all_technique_traits() {
  return techniques;
}

const TechniqueTraits& traits_of(Technique technique) {
  return techniques[static_cast<std::size_t>(technique)];
}

bool RasterFrame::has_map() const {
  return has_known_map() && traits_of(options.map.technique).contents != MapContents::nothing;
}

std::span<const FilterKernelTraits> all_filter_kernel_traits() {
  return kernels;
}

const FilterKernelTraits& traits_of(FilterKernel kernel) {
  return kernels[static_cast<std::size_t>(kernel)];
}

}  // namespace gnomon::raster
