#include "raster/settings.h"

#include <algorithm>

#include "raster/setting_kinds.h"

namespace gnomon::raster {
namespace {

using Traits = TechniqueTraits;

bool compares(const Traits& t) {
  return compares_depths(t.technique);
}
bool has_a_map(const Traits& t) {
  return t.contents != MapContents::nothing;
}
bool samples(const Traits& t) {
  return t.test == ShadowTest::sampled;
}
/// A midpoint lies between two casters as they are.
bool moves_casters(const Traits& t) {
  return compares(t) && t.contents != MapContents::midpoint_depth;
}
bool compares_one_depth(const Traits& t) {
  return t.test == ShadowTest::single;
}
bool averages(const Traits& t) {
  return t.test == ShadowTest::averaged;
}
bool compares_with_depths(const Traits& t) {
  return compares_one_depth(t) || averages(t);
}
bool filters_moments(const Traits& t) {
  return t.test == ShadowTest::moments;
}
/// Nothing bleeds through an exponential map of one moment: what is too bright there has another cause.
bool bleeds(const Traits& t) {
  return filters_moments(t) && t.floats_per_texel > 1;
}
/// A map of back faces has its side already.
bool chooses_sides(const Traits& t) {
  return compares(t) && t.contents != MapContents::back_depth;
}
/// A sun's map that is one window; a cube's faces do not move, and cascades snap by an option of their own.
bool can_stand_still(const Traits& t) {
  return compares(t) && t.texels != TexelShape::cascades && t.lights.has(LightType::directional);
}
/// The map is one window, or a cube about its light, and no fit to the camera changes it.
bool lies_still(const Traits& t) {
  return compares(t) && t.texels == TexelShape::of_light;
}
/// Only a directional light's window can be moved.
bool has_a_window(const Traits& t) {
  return lies_still(t) && t.lights.has(LightType::directional);
}
bool averages_kernel(const Traits& t) {
  return t.filter == EdgeFilter::kernel;
}
bool searches_penumbra(const Traits& t) {
  return t.filter == EdgeFilter::penumbra;
}
bool cascades(const Traits& t) {
  return t.texels == TexelShape::cascades;
}
template <Technique only>
bool is(const Traits& t) {
  return t.technique == only;
}

bool has_radius(FilterKernel kernel) {
  return kernel != FilterKernel::hardware;
}
bool has_samples(FilterKernel kernel) {
  return kernel == FilterKernel::vogel;
}

constexpr auto of_bias = &MapOptions::bias;
constexpr auto of_filter = &MapOptions::filter;
constexpr auto of_cascades = &MapOptions::cascades;
constexpr auto of_window = &MapOptions::window;
constexpr auto of_rays = &MapOptions::rays;
using W = LightWindow;
constexpr OptionRange any_place{-1e30, 1e30};
using F = FilterOptions;
using C = CascadeOptions;
using R = RayOptions;

static_assert(automatic_bias_texels == 0.0625 && MapOptions{}.bias.slope == 1.0,
              "the help of two rows says so");

// Each limit that no reason sets is far beyond what is useful and short of what overflows a float. A filter's radius of 0
// would be the kernel of `hard`.
constexpr MapSetting rows[] = {
    {.name = "map-size",
     .key = "size",
     .group = SettingGroup::map,
     .kind = integer<&MapOptions::size>("texels", 1, 65536, 16, 16384, true),
     .read_by = has_a_map,
     .type = "N",
     .help = "side of the shadow map, as far as the graphics context allows",
     .title = "Map size",
     .what = "Texels on a side of the depth map.",
     .acne = "Twice the texels need half the bias.",
     .peter_panning = "Less bias is enough, so shadows start closer to their casters."},
    {.name = "window-size",
     .key = "size",
     .group = SettingGroup::window,
     .kind = list<of_window, &W::size>("world units", {0.0, 1e30, true}, 2, 2),
     .read_by = has_a_window,
     .type = "W,H",
     .help = "width and height of a directional light's map, as your engine has them",
     .title = "Window",
     .what = "Width and height of a directional light's map, as an engine has them.",
     .acne = "A wider window has larger texels, which need more bias.",
     .peter_panning = "A wider window needs more bias, so shadows start farther from their casters.",
     .range_help = "world units, above 0; auto fits them to the casters and the view"},
    {.name = "window-origin",
     .key = "origin",
     .group = SettingGroup::window,
     .kind = list<of_window, &W::origin>("world units", any_place, 3, 3),
     .read_by = has_a_window,
     .type = "X,Y,Z",
     .help =
         "where a directional light's camera stands: the window's middle, from which --window-depths counts",
     .title = "Window's origin",
     .what = "Where a directional light's camera stands: the middle of its window.",
     .range_help = "world units; auto fits it to the casters and the view"},
    {.name = "window-depths",
     .key = "depths",
     .group = SettingGroup::window,
     .kind = list<of_window, &W::depths>("world units", any_place, 2, 2, true),
     .read_by = lies_still,
     .type = "NEAR,FAR",
     .help =
         "near and far plane of the map: along the light from --window-origin or from the middle of what is "
         "finite, or from a spot or point light; casters before the near plane are drawn at it",
     .title = "Near and far",
     .what = "Near and far plane of the map, along the light.",
     .acne = "A longer range makes the steps of few bits larger: speckles.",
     .peter_panning = "Casters before the near plane are stored at it: their shadows have no gap that fits.",
     .range_help = "world units, ascending; auto fits them to casters and receivers"},
    {.name = "technique",
     .key = "technique",
     .group = SettingGroup::map,
     .kind = choice<&technique_values, &MapOptions::technique>(),
     .type = "NAME",
     .help = "shadow test",
     .title = "Technique",
     .what = "What the map stores and how it is looked up.",
     .acne =
         "Techniques that compare depths need a bias against it; filters turn it into grey; hybrid, izb and "
         "rays have none.",
     .peter_panning = "As much as the bias; hybrid, izb and rays have none."},
    {.name = "bias",
     .group = SettingGroup::bias,
     .kind = ConstantBiasSetting{&Bias::constant, &Bias::unit, true},
     .read_by = compares,
     .type = "auto|B|Btexel",
     .help = "constant bias: a receiver is shadowed when the map's depth is nearer than this",
     .title = "Constant bias",
     .what = "How much nearer to the light the map's depth must be before it shadows.",
     .acne = "More takes acne away, from the faces that look at the light first.",
     .peter_panning = "More makes it: the shadow starts that much behind its caster.",
     .range_help =
         "world units along the light ray, or texels with the suffix texel, any finite number; auto "
         "is what rounding may do, and 0.0625 texel; asked for, any bias takes the place of the "
         "default's slope bias"},
    {.name = "slope-bias",
     .key = "slope",
     .group = SettingGroup::bias,
     .kind = number<of_bias, &Bias::slope>("multiples of the depth slope over half a texel",
                                           {-1000.0, 1000.0}, {0.0, 4.0}),
     .read_by = compares,
     .type = "NUMBER",
     .help = "slope bias; 1 leaves no acne on a plane",
     .title = "Slope bias",
     .what =
         "In multiples of the depth by which the surface falls over half a texel: 1 is what a plane needs.",
     .acne = "1 leaves none on a plane.",
     .peter_panning = "Only as much as the slope asks for, but much at grazing light.",
     .slider_unit = "x slope",
     .default_help = "1, or 0 where another bias is asked for or the technique brings its own"},
    {.name = "normal-offset",
     .key = "normal_offset_texels",
     .group = SettingGroup::bias,
     .kind = number<of_bias, &Bias::normal_offset_texels>("texels", {0.0, 1000.0}, {0.0, 4.0}),
     .read_by = compares,
     .type = "NUMBER",
     .help = "moves the receiver along its normal, scaled by the sine of the light's angle",
     .title = "Normal offset",
     .what = "Looks the map up from a point that is moved along the surface's normal.",
     .acne = "More takes it away, mostly where light grazes.",
     .peter_panning = "Little along the light, but shadows grow thinner and move sideways."},
    {.name = "receiver-plane",
     .key = "receiver_plane",
     .group = SettingGroup::bias,
     .kind = on_off<of_bias, &Bias::receiver_plane>(SwitchForm::flag),
     .read_by = compares_one_depth,
     .help = "compare with the depth of the receiver's plane at the texel's centre",
     .title = "Receiver plane",
     .what = "Compares with the receiver's own plane at the texel's centre.",
     .acne = "None is left on a plane.",
     .peter_panning = "None on planes; at edges and folds the plane is the wrong one."},
    {.name = "adaptive-bias",
     .key = "adaptive",
     .group = SettingGroup::bias,
     .kind = on_off<of_bias, &Bias::adaptive>(SwitchForm::flag),
     .read_by = compares_with_depths,
     .help = "as much bias as the receiver's plane rises up to the texel's centre, and 1e-4 of the scene's "
             "size; with --bias 0 it stands alone",
     .title = "Adaptive bias",
     .what = "As much as the receiver's plane rises up to the texel's centre (Dou et al. 2014).",
     .acne = "None is left on a plane.",
     .peter_panning = "As little as the place in the texel allows."},
    {.name = "caster-bias",
     .group = SettingGroup::bias,
     .kind = ConstantBiasSetting{&Bias::caster_constant, &Bias::caster_unit, false},
     .read_by = moves_casters,
     .type = "B|Btexel",
     .help = "constant bias of casters: the map stores them so much farther from the light",
     .title = "Casters' constant bias",
     .what = "How much farther from the light the map stores its casters. A graphics card's depth bias costs "
             "nothing; here a shader moves each depth, so that the map takes up to twice as long to draw.",
     .acne = "More takes acne away, as the same constant bias of receivers does.",
     .peter_panning = "More makes it, as the same constant bias of receivers does.",
     .range_help =
         "world units along the light ray, or texels with the suffix texel, any finite number; asked for, it "
         "takes the place of the default's slope bias"},
    {.name = "caster-slope-bias",
     .key = "caster_slope",
     .group = SettingGroup::bias,
     .kind = number<of_bias, &Bias::caster_slope>("multiples of the stored depth's slope from texel to texel",
                                                  {-1000.0, 1000.0}, {0.0, 4.0}),
     .read_by = moves_casters,
     .type = "NUMBER",
     .help = "slope-scaled bias of casters, the factor of glPolygonOffset; 1 leaves no acne on a plane",
     .title = "Casters' slope bias",
     .what = "Stores casters farther by multiples of what their depth changes from texel to texel, as "
             "graphics cards do, which costs them nothing; here the map takes up to twice as long to draw.",
     .acne = "1 leaves none on a plane.",
     .peter_panning = "As much as the casters' own slope asks for, whatever the receiver is.",
     .slider_unit = "x slope"},
    {.name = "depth-format",
     .key = "depth_format",
     .group = SettingGroup::map,
     .kind = choice<&depth_formats, &MapOptions::depth_format>(),
     .read_by = compares,
     .type = "NAME",
     .help = "number format of the stored depth",
     .title = "Depth format",
     .what = "The number format of the stored depth.",
     .acne = "Few bits round the depth: speckles that look like acne.",
     .peter_panning = "None, but that coarser steps ask for more bias."},
    {.name = "cull",
     .key = "cull",
     .group = SettingGroup::map,
     .kind = choice<&culls, &MapOptions::cull>(),
     .read_by = chooses_sides,
     .type = "SIDE",
     .help = "sides of surfaces that the map leaves out",
     .title = "Leave out",
     .what = "The sides of surfaces that the map leaves out, as the light sees them.",
     .acne = "Without front faces, lit surfaces cannot shadow themselves; the back sides do.",
     .peter_panning = "Without front faces a thin caster's shadow starts behind it, and open meshes leak."},
    {.name = "filter-kernel",
     .group = SettingGroup::filter,
     .kind = choice<&kernel_values, of_filter, &F::kernel>(),
     .read_by = averages_kernel,
     .type = "NAME",
     .help = "N x N texels alike, 2 x 2 bilinear, a disc turned at every pixel, or a sliding square",
     .title = "Kernel",
     .what = "Which texels are compared with, and how they are weighed.",
     .acne = "A filter turns its stripes into grey; it does not take them away.",
     .peter_panning = "Blurs the gap."},
    {.name = "filter-radius",
     .group = SettingGroup::filter,
     .kind = number<of_filter, &F::radius_texels>("texels", {0.001, 64.0}, {0.5, 16.0}, true),
     .read_by = averages_kernel,
     .read_by_kernel = has_radius,
     .type = "NUMBER",
     .help = "half the kernel's width; box covers 2 floor(radius) + 1",
     .title = "Radius",
     .what = "Half the kernel's width.",
     .acne = "A wider kernel needs more bias, unless it follows the receiver's plane.",
     .peter_panning = "Blurs the gap."},
    {.name = "filter-plane",
     .group = SettingGroup::filter,
     .kind = on_off<of_filter, &F::receiver_plane>(SwitchForm::word),
     .read_by = averages,
     .type = "on|off",
     .help = "compare each texel with the receiver's plane at its centre, not with its own depth",
     .title = "Follow the plane",
     .what =
         "Compares each texel with the receiver's plane at its centre, not with the receiver's own depth.",
     .acne = "Off, slopes shadow themselves over the kernel's width."},
    {.name = "filter-samples",
     .key = "samples",
     .group = SettingGroup::filter,
     .kind = integer<of_filter, &F::samples>("lookups", 1, 1024, 1, 128),
     .read_by = averages,
     .read_by_kernel = has_samples,
     .type = "N",
     .help = "points of the filter",
     .title = "Samples",
     .what = "Points of the filter."},
    {.name = "blocker-samples",
     .key = "blocker_samples",
     .group = SettingGroup::filter,
     .kind = integer<of_filter, &F::blocker_samples>("lookups", 1, 1024, 1, 128),
     .read_by = searches_penumbra,
     .type = "N",
     .help = "points of the search for what blocks the light",
     .title = "Blocker samples",
     .what = "Points of the search for what blocks the light."},
    {.name = "search-radius",
     .key = "search_radius",
     .group = SettingGroup::filter,
     .kind =
         number<of_filter, &F::search_radius>("texels of a map of 1024", {0.001, 1024.0}, {1.0, 256.0}, true),
     .read_by = searches_penumbra,
     .type = "NUMBER",
     .help = "the search goes no farther, however large the light; a map of another size searches as wide a "
             "part of itself",
     .title = "Search radius",
     .what = "The search goes no farther, however large the light. A map of another size searches as wide a "
             "part of itself.",
     .acne = "A wide search takes the receiver itself for a blocker."},
    {.name = "blur-radius",
     .key = "blur_radius_texels",
     .group = SettingGroup::filter,
     .kind = integer<of_filter, &F::blur_radius_texels>("texels", 0, 64, 0, 16),
     .read_by = filters_moments,
     .type = "N",
     .help = "the map is averaged over 2 N + 1 texels each way",
     .title = "Blur radius",
     .what = "The map is averaged over 2 N + 1 texels each way.",
     .acne = "Averages it away.",
     .peter_panning = "Light leaks in where the blur mixes near and far."},
    {.name = "mipmaps",
     .key = "mipmaps",
     .group = SettingGroup::filter,
     .kind = on_off<of_filter, &F::mipmaps>(SwitchForm::word),
     .read_by = filters_moments,
     .type = "on|off",
     .help = "pixels that cover several texels read their average",
     .title = "Mipmaps",
     .what = "Pixels that cover several texels read their average."},
    {.name = "bleeding-reduction",
     .key = "bleeding_reduction",
     .group = SettingGroup::filter,
     .kind = number<of_filter, &F::light_bleeding_reduction>("visibility", {0.0, 0.999}, {0.0, 0.9}),
     .read_by = bleeds,
     .type = "NUMBER",
     .help = "up to this is drawn black, the rest stretched",
     .title = "Bleeding reduction",
     .what = "Visibility up to this is drawn black, the rest is stretched.",
     .acne = "More makes grey speckles black.",
     .peter_panning = "Takes away the light that bleeds into shadows, and narrows penumbrae."},
    {.name = "esm-exponent",
     .key = "exponent",
     .group = SettingGroup::filter,
     .kind =
         number<of_filter, &F::esm_exponent>("per depth range of the map", {0.001, 80.0}, {1.0, 80.0}, true),
     .read_by = is<Technique::esm>,
     .type = "NUMBER",
     .help = "c in exp(c z)",
     .title = "Exponent",
     .what = "c in exp(c z).",
     .acne = "A large one brings it back.",
     .peter_panning = "A small one lets light through near the caster.",
     .slider_unit = "per range"},
    {.name = "evsm-exponent",
     .key = "exponent",
     .group = SettingGroup::filter,
     .kind = number<of_filter, &F::evsm_positive_exponent>("per half depth range", {0.001, 40.0}, {1.0, 40.0},
                                                           true),
     .read_by = is<Technique::evsm>,
     .type = "NUMBER",
     .help = "p in exp(p z)",
     .title = "Exponent",
     .what = "p in exp(p z).",
     .peter_panning = "A larger one leaks less.",
     .slider_unit = "per half range"},
    {.name = "evsm-negative-exponent",
     .key = "negative_exponent",
     .group = SettingGroup::filter,
     .kind = number<of_filter, &F::evsm_negative_exponent>("per half depth range", {0.001, 40.0}, {0.5, 40.0},
                                                           true),
     .read_by = is<Technique::evsm>,
     .type = "NUMBER",
     .help = "n in -exp(-n z)",
     .title = "Negative exponent",
     .what = "n in -exp(-n z).",
     .peter_panning = "A larger one leaks less behind near casters.",
     .slider_unit = "per half range"},
    {.name = "moment-bias",
     .key = "moment_bias",
     .group = SettingGroup::filter,
     .kind = number<of_filter, &F::moment_bias>("share", {0.0, 1.0}, {0.0, 1e-4}),
     .read_by = is<Technique::msm>,
     .type = "NUMBER",
     .help = "of a fixed distribution, mixed into the moments against rounding",
     .title = "Moment bias",
     .what = "Share of a fixed distribution mixed into the moments against rounding.",
     .acne = "Takes away rounding's speckles.",
     .peter_panning = "More leaks more light."},
    {.name = "cascades",
     .key = "count",
     .group = SettingGroup::cascades,
     .kind = integer<of_cascades, &C::count>("", 1, 6, 1, 6),
     .read_by = cascades,
     .type = "N",
     .help = "slices of the view, one map each",
     .title = "Cascades",
     .what = "Slices of the view, one map each.",
     .acne = "Smaller texels near the eye need less bias there.",
     .peter_panning = "Less near the eye."},
    {.name = "cascade-lambda",
     .key = "lambda",
     .group = SettingGroup::cascades,
     .kind = number<of_cascades, &C::lambda>("share", {0.0, 1.0}, {0.0, 1.0}),
     .read_by = cascades,
     .type = "NUMBER",
     .help = "how the view's depth is split: 0 evenly, 1 evenly in its logarithm",
     .title = "Split",
     .what = "0 splits the view's depth evenly, 1 evenly in its logarithm.",
     .acne = "More gives the near slices smaller texels.",
     .peter_panning = "Less near the eye."},
    {.name = "cascade-splits",
     .key = "splits",
     .group = SettingGroup::cascades,
     .kind = list<of_cascades, &C::splits>("world units", {0.0, 1e30, true}, 1, 6, true),
     .read_by = cascades,
     .type = "D1,D2,...",
     .help = "the depth from the camera at which each slice ends, as your engine has them; as many as there "
             "are cascades",
     .title = "Splits",
     .what = "The depth from the camera at which each slice ends.",
     .acne = "Shorter slices have smaller texels, which need less bias.",
     .peter_panning = "Less where slices are short.",
     .range_help = "world units, ascending; auto splits by --cascade-lambda"},
    {.name = "no-snap",
     .key = "snap",
     .group = SettingGroup::cascades,
     .kind = on_off<of_cascades, &C::snap>(SwitchForm::off_flag),
     .read_by = cascades,
     .help = "fit each cascade tightly instead of moving it by whole texels; shadows then swim",
     .title = "Snap to texels",
     .what = "Moves each cascade by whole texels, so that shadows do not swim."},
    {.name = "cascade-fit",
     .key = "fit_samples",
     .group = SettingGroup::cascades,
     .kind = on_off<of_cascades, &C::fit_samples>(SwitchForm::flag),
     .read_by = cascades,
     .help = "fit splits and cascades to the surfaces that the camera sees; implies --no-snap",
     .title = "Fit to surfaces",
     .what = "Fits splits and cascades to the surfaces that the camera sees; they then swim.",
     .acne = "Smaller texels need less bias.",
     .peter_panning = "Less."},
    {.name = "cascade-blend",
     .key = "blend",
     .group = SettingGroup::cascades,
     .kind = number<of_cascades, &C::blend>("share of a cascade's width", {0.0, 0.5}, {0.0, 0.5}),
     .read_by = cascades,
     .type = "NUMBER",
     .help = "how far from its border on a cascade is mixed with the next; 0 leaves a seam",
     .title = "Blend",
     .what =
         "Along the border of a slice, over this share of its width, its test is mixed with the next one's.",
     .slider_unit = "share"},
    {.name = "snap",
     .key = "snap",
     .group = SettingGroup::map,
     .kind = on_off<&MapOptions::snap>(SwitchForm::flag),
     .read_by = can_stand_still,
     .help =
         "let the map of a directional light stand still between steps, so that edges hold still: sizes by "
         "steps of a quarter octave, places by whole texels (lispsm: all by steps); costs up to a fifth of "
         "the resolution along each axis",
     .title = "Snap to steps",
     .what = "The map grows by steps and moves by whole texels, so that shadows do not swim.",
     .acne = "None; its texels are larger.",
     .peter_panning = "None; its texels are larger."},
    {.name = "rays",
     .key = "rays_per_pixel",
     .group = SettingGroup::rays,
     .kind = choice<&ray_counts, of_rays, &R::count>(),
     .read_by = samples,
     .type = "N",
     .help = "rays for each pixel to a light with size; 1/4 is one for 2 x 2 pixels",
     .title = "Rays",
     .what = "Rays for each pixel to points of a light with size; a light without size takes one, which is "
             "exact.",
     .acne = "None: rays start off their surface by rounding's own bound."},
    {.name = "ray-sampler",
     .key = "ray_sampler",
     .group = SettingGroup::rays,
     .kind = choice<&ray_samplers, of_rays, &R::sampler>(),
     .read_by = samples,
     .type = "NAME",
     .help = "which points of the light the rays go to",
     .title = "Sampler",
     .what = "Which points of the light the rays go to: each alone, one in each part of it, or so that "
             "neighbouring pixels complete each other."},
    {.name = "denoiser",
     .key = "denoiser",
     .group = SettingGroup::rays,
     .kind = choice<&denoisers, of_rays, &R::denoiser>(),
     .read_by = samples,
     .type = "NAME",
     .help = "what is made of the rays' noise: a filter as wide as the penumbra, an edge-avoiding wavelet, "
             "one guided by variance, or AMD's",
     .title = "Denoiser",
     .what = "What is made of the rays' noise.",
     .peter_panning = "A denoiser takes thin shadows for noise and greys them."},
    {.name = "history",
     .key = "history",
     .group = SettingGroup::rays,
     .kind = integer<of_rays, &R::history>("frames", 1, 64, 1, 64),
     .read_by = samples,
     .type = "N",
     .help = "frames of a camera that stands still that the picture is drawn from",
     .title = "History",
     .what = "Frames of a camera that stands still that the picture is drawn from."},
};

}  // namespace

std::span<const MapSetting> map_settings() {
  return rows;
}

const MapSetting* find_setting(std::string_view name) {
  const auto found = std::find_if(std::begin(rows), std::end(rows),
                                  [&](const MapSetting& setting) { return setting.name == name; });
  return found == std::end(rows) ? nullptr : &*found;
}

bool reads(const TechniqueTraits& technique, const MapSetting& setting) {
  return setting.read_by == nullptr || setting.read_by(technique);
}

bool reads(const MapOptions& map, const MapSetting& setting) {
  if (!reads(traits_of(map.technique), setting)) return false;
  return !has_kernel(map.technique) || setting.read_by_kernel == nullptr ||
         setting.read_by_kernel(map.filter.kernel);
}

bool reads_setting(const MapOptions& map, std::string_view name) {
  const MapSetting* setting = find_setting(name);
  return setting == nullptr || reads(map, *setting);
}

std::string_view depth_format_name(DepthFormat format) {
  return name_among(depth_formats(), format);
}

std::string_view cull_name(Cull cull) {
  return name_among(culls(), cull);
}

}  // namespace gnomon::raster
