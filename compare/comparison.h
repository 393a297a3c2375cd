// The comparison as plain data: the visibility ladder of every pixel, its label, and what the program says
// about it. Everything that writes files (result.json, pictures, report) reads this and nothing else.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/ext/vector_int3_sized.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/result/threshold.h"
#include "compare/view_errors.h"
#include "raster/frame.h"
#include "raytrace/frame.h"
#include "raytrace/tracer.h"
#include "scene/base/time_difference.h"
#include "scene/base/timing.h"
#include "scene/effects.h"
#include "scene/image.h"
#include "scene/world.h"

namespace gnomon::compare {

/// What a pixel shows, as far as the report page needs it: an eighth of the size of the ray tracer's receiver.
struct SeenSurface {
  static constexpr double normal_steps = 32767.0;
  std::uint32_t primitive = no_id;
  /// The geometric one, in normal_steps, on the side of the camera; 0 where there is none.
  glm::i16vec3 normal{0};

  SeenSurface() = default;
  explicit SeenSurface(const raytrace::SurfacePoint& receiver);
};

Image<SeenSurface> seen_surfaces(const Image<raytrace::SurfacePoint>& receivers);

/// V0 … V6: the truth, and what changes one thing at a time until it is what the rasterizer drew.
enum class Rung : std::uint8_t { truth, point, texel, flat, stored, biased, drawn };
inline constexpr std::size_t rung_count = 7;

/// The step down to rung k + 1 is charged to cause k.
enum class Cause : std::uint8_t {
  light_size,
  sampling,
  slope,
  precision,
  bias,
  filter,
  caster,  ///< of another renderer's map whose casters are not the scene's: it has no rung of its own
  // Of few rays (Ladder::rays) the last four steps are these, and the first two change nothing.
  rays_blur = slope,
  rays_lag = precision,
  rays_noise = bias,
  rays_remap = filter
};
/// Which changes lead from the truth to the drawing: those of a map, or those of a few rays and their denoiser.
enum class Ladder : std::uint8_t { map, rays };
Ladder ladder_of(raster::Technique technique);
inline constexpr std::size_t cause_count = 6;  ///< those with a rung
std::string_view cause_name(Cause cause, Ladder ladder = Ladder::map);

/// Values are those of the class.V channel.
enum class Label : std::int8_t {
  uncertain = -4,
  silhouette = -3,
  facing_away = -2,
  background = -1,
  right = 0,
  acne,
  stored_depth,  ///< "precision"
  peter_panning,
  light_leak,
  aliasing,
  missed_feature,
  false_feature,
  blur,
  light_size,
  outside_map,
  custom_shader,
  unexplained,
  caster_bias,
  missing_caster,
  moved_caster,
  clipped_caster,
  culled_caster,
  ignored_alpha,
  noise,
  lag,
  remap
};
inline constexpr std::size_t class_count = 21;  ///< the wrong ones, acne … remap
std::string_view label_name(Label label);  ///< as in result.json; "right", "background", … for the others
/// Tells whether a pixel has an error: its label is what caused it. It is wrong where that is more than one half (is_wrong).
inline bool has_cause(Label label) {
  return static_cast<int>(label) > 0;
}
inline bool is_compared(Label label) {
  return static_cast<int>(label) >= 0;
}

struct PixelCounts {
  std::uint64_t total = 0, background = 0, facing_away = 0, silhouette = 0, uncertain = 0, compared = 0;
  /// Counts the uncertain pixels that only the samples of a light with size leave open (ladder.h).
  std::uint64_t uncertain_by_samples = 0;
};

/// The error is V6 - V0 over compared pixels.
struct ErrorStats {
  std::uint64_t wrong = 0, false_shadow = 0, missed_shadow = 0;  ///< |V6 - V0| > 1/2, and which way
  std::uint64_t ties = 0;        ///< |V6 - V0| = 1/2 exactly: as near to right as to wrong
  std::uint64_t fractional = 0;  ///< V0 or V6 between 0 and 1: for 0 the mean is the share of wrong pixels
  double wrong_fraction = 0.0;   ///< (wrong + ties / 2) / compared
  double mean_absolute = 0.0, rms = 0.0;
  /// These compare the drawn with the true visibility picture; NaN where not computed. The last two are means over the
  /// compared pixels alone, of SSIM over the windows around them.
  double flip = std::numeric_limits<double>::quiet_NaN();  ///< mean FLIP (Andersson et al. 2020)
  double ssim = std::numeric_limits<double>::quiet_NaN();  ///< mean SSIM (Wang et al. 2004)
  double flip_compared = std::numeric_limits<double>::quiet_NaN();
  double ssim_compared = std::numeric_limits<double>::quiet_NaN();
};

/// Of the finished pictures, where all that is said of a light is said of its visibility.
struct ShadedError {
  double mean_absolute =
      0.0;            ///< of the colours as a screen shows them, in [0, 1], over all pixels but silhouettes
  double flip = 0.0;  ///< mean FLIP
};

struct BudgetStep {
  double signed_mean = 0.0;    ///< mean of V[k+1] - V[k] over compared pixels; together mean(V6 - V0)
  double absolute_mean = 0.0;  ///< mean of |V[k+1] - V[k]|
  /// The wrong pixels whose label stands for this step (step_of_label); over the steps they sum to
  /// ErrorStats::false_shadow and missed_shadow.
  std::uint64_t false_shadow = 0, missed_shadow = 0;
  /// What the step takes and what it adds: lightened() - darkened() is signed_mean, their sum absolute_mean.
  double darkened() const { return 0.5 * (absolute_mean - signed_mean); }
  double lightened() const { return 0.5 * (absolute_mean + signed_mean); }
};

/// By cause; the last entry is that of casters, to which the deciding step of a pixel with such a label is charged.
using Budget = std::array<BudgetStep, cause_count + 1>;

/// Pixels drawn right though the sampling step had made them wrong: a later error undid the first.
struct RightByAccident {
  std::uint64_t shadowed = 0;  ///< truly shadowed, and dark only because the surface shadows itself
  std::uint64_t lit = 0;       ///< truly lit, and lit only because the test let light past the stored caster
};

struct EdgeStats {
  std::uint64_t edges = 0;   ///< true shadow edges measured (pixel pairs)
  double mean_texels = 0.0;  ///< signed, > 0 where the drawn shadow is larger than the true one
  double rms_texels = 0.0, rms_pixels = 0.0;
  double mean_absolute_texels = 0.0;
  /// These are lengths along the receiver, world units.
  double mean_world = 0.0, mean_absolute_world = 0.0, rms_world = 0.0;
};

/// How far the drawn shadow starts from its caster, on pixels that the bias lets light through to.
struct Detachment {
  std::uint64_t pixels = 0;
  double mean_world = 0.0, max_world = 0.0;
  double rms_world = 0.0;
};

struct BiasCurvePoint {
  double bias = 0.0;  ///< constant, as raster::LightRecord::bias_constant_world
  std::uint64_t false_shadow = 0, missed_shadow = 0;
  double wrong_fraction = 0.0;  ///< by the rule for ties (wrong_share), as that of BestBias
};

/// The constant bias with the fewest wrong pixels, all else as rendered, and whether one can be right
/// everywhere. When none can, the proof stands in the last four fields. `lit_pixels_above` truly lit pixels need
/// a bias of at least needs_more_than. `shadowed_pixels_below` truly shadowed ones need less than
/// needs_less_than. No bias >= 0 satisfies both: needs_less_than <= needs_more_than, or needs_less_than <= 0.
struct BestBias {
  double constant_world = 0.0;
  double wrong_fraction = 0.0;
  bool feasible = false;  ///< some constant bias >= 0 makes every compared pixel right
  /// Feasible: the largest gap among lit pixels (-infinity: none), the interval's start. Otherwise the
  /// smallest gap among the lit pixels that the best bias leaves in false shadow (the largest of all lit gaps
  /// when it leaves none).
  double needs_more_than = 0.0;
  /// Feasible: the smallest gap among shadowed pixels (+infinity: none), the interval's end. Otherwise the
  /// largest gap among the shadowed pixels that the best bias misses (the smallest of all shadowed gaps when
  /// it misses none).
  double needs_less_than = 0.0;
  std::uint64_t lit_pixels_above = 0;       ///< lit pixels with gap >= needs_more_than; 0 when feasible
  std::uint64_t shadowed_pixels_below = 0;  ///< shadowed pixels with gap <= needs_less_than; 0 when feasible
  struct Setting {
    double constant_world = 0.0;
    double wrong_fraction = 0.0;
  };
  /// Where the fewest lie far out on a plateau: a clearly smaller constant that is hardly wrong more often
  /// (smallest_good_range of bias_kinds.h).
  std::optional<Setting> smaller = std::nullopt;
  /// The best constant with three digits in the unit that it is given in, and what is wrong at that.
  std::optional<Setting> rounded = std::nullopt;
  /// What to recommend: the smaller one where there is one.
  Setting advised() const {
    return smaller.value_or(rounded.value_or(Setting{constant_world, wrong_fraction}));
  }
};

/// One kind of bias at its smallest setting that is hardly wrong more often than its best (bias_kinds.h), as
/// the drawing's own map answers.
struct BiasKind {
  std::string_view name;  ///< "slope bias"
  raster::Bias bias;      ///< the setting
  double wrong_fraction = 0.0;
  bool of_slope = false;  ///< from and to are multiples of a slope; else constants as bias_constant_world
  double from = 0.0, to = 0.0;  ///< settings from `from` on and below `to` are hardly worse, too
};

/// What a map of another size would leave, all else as drawn: an estimate (ladder/other_sizes.h), which tells what is worth
/// a drawing.
struct OtherMapSize {
  int size = 0;                                      ///< texels on a side
  double mean_absolute = 0.0, standard_error = 0.0;  ///< as ErrorStats::mean_absolute; of the estimate
};

/// Describes the finite values over compared pixels.
struct Distribution {
  std::uint64_t count = 0;
  double median = 0.0, p90 = 0.0, p99 = 0.0, max = 0.0;
};

/// What closed forms say of the map (theory.h).
struct TheoryStats {
  Distribution acne_free_bias;  ///< least constant bias without acne on the tangent plane, world units
  /// Sides of a texel in pixels on the receiver, predicted as the product of two parts, and measured.
  Distribution aliasing, perspective, projection, measured_aliasing;
};

/// What the filter of vsm, esm, evsm or msm lets through inside a shadow (ladder/filter_probe.h): a part of the filter
/// step.
struct BleedingStats {
  std::uint64_t pixels = 0;
  double mean = 0.0;  ///< of V6 - V5 on them, over all compared pixels
  double max = 0.0;   ///< of V6 - V5
};

/// Soft shadows in truth and as drawn (penumbra.h); widths are medians over the edges where both were found.
struct PenumbraStats {
  std::uint64_t edges = 0, umbra_edges = 0;
  double true_penumbra_world = 0.0, drawn_penumbra_world = 0.0;
  double true_umbra_world = 0.0, drawn_umbra_world = 0.0;
  /// Counts the pixels climbed (labels_climbed), with those that only samples leave uncertain: without them an area would
  /// have holes where half of the light is seen.
  std::uint64_t true_umbra_pixels = 0, true_penumbra_pixels = 0;
  std::uint64_t drawn_umbra_pixels = 0, drawn_penumbra_pixels = 0;
  /// Describes the truth's samples, over compared pixels whose truth lies between 0 and 1.
  double standard_error_mean = 0.0, standard_error_max = 0.0;
  /// How far the share of the unshadowed light that arrives lies from V0, the share of the light that is seen: a mean over
  /// receivers that see a part (measure/weighted_light.h); NaN where not measured.
  double weighted_difference = std::numeric_limits<double>::quiet_NaN();
};

/// What rays to the light's centre meet, counted on rays spread over the picture, one by one through the tree.
struct RayWork {
  std::uint64_t rays = 0, boxes = 0, primitives = 0;  ///< tested
};

/// Describes a film whose first frame is the comparison's picture (studies/shimmer/shimmer.h).
struct ShimmerFigures {
  int frames = 0;
  double fps = 0.0;
  std::uint64_t receiver_steps = 0;  ///< receivers compared in two following frames, over all pairs of them
  std::uint64_t flips = 0;
  double flips_per_receiver_second = 0.0;
  double mean_absolute = 0.0;  ///< of the temporal error
};

/// Where cascades, or the faces of a cube, meet (cascades.h).
struct SeamCount {
  std::uint64_t at_border = 0;  ///< receivers beside a change of cascades or faces
  std::uint64_t changed =
      0;  ///< of them those whose visibility changes only because the cascade or face does
};

/// Where a triangle and its smooth normal do not both face the light (terminator.h); both renderers go by the triangle.
struct TerminatorCount {
  std::uint64_t dark = 0;   ///< facing away, though the smooth normal faces the light
  std::uint64_t unlit = 0;  ///< compared, though the smooth normal faces away, so that no light is seen there
};

/// Counts compared pixels whose lookup falls beside the map, or beyond its depths where it holds nothing.
struct OutsideMap {
  std::uint64_t receivers = 0;
  std::uint64_t shadowed = 0;    ///< of them those truly in shadow, for the larger part
  std::uint64_t drawn_dark = 0;  ///< of them those that are drawn in shadow, for the larger part
};

/// Describes the compared pixels that look up one cascade.
struct CascadeFigures {
  std::uint64_t compared = 0;
  ErrorStats error;
  Budget budget{};
};

/// What the shadows of a frame take on both sides, milliseconds, by what has moved since the last one
/// (result/shadow_cost.h).
struct ShadowCosts {
  struct Sides {
    TimeDifference map, rays;  ///< map: of the hybrid what it has in its place
  };
  Sides nothing_moves, light_moves, casters_move;
};

/// What depends on the map and on which pixels are compared, but not on how the map is looked up.
struct MapMeasures {
  std::array<double, 3> texel_world{};  ///< min, median, max over compared receivers
  TheoryStats theory;
  TerminatorCount terminator;  ///< of the compared pixels and those beside them; no map has a part in it
};

/// Numbers that another constant bias leaves as they are.
struct BiasFreeFigures : MapMeasures {
  PixelCounts pixels;
  OutsideMap outside;
  std::optional<std::uint64_t> lookups;  ///< LightRecord::lookups of the compared pixels; none: not counted
  double bias_texel_world = 0.0;         ///< what a bias in texels is a multiple of
  BestBias best_bias;                    ///< without meaning where LightLists::bias_curve is empty
};

/// Every number of one light; result/figure_rows.cpp has a row for each, but for theory and biases.
struct LightFigures : BiasFreeFigures {
  ErrorStats error;
  Budget budget{};
  RightByAccident accidents;
  EdgeStats edges;
  Detachment detachment;
  std::optional<BleedingStats> bleeding;    ///< of techniques of moments
  std::optional<PenumbraStats> penumbra;    ///< of a light with size
  std::optional<SeamCount> seams;           ///< of the hard test in several maps
  std::optional<ShimmerFigures> shimmer;    ///< where a film was asked for, too
  RayWork ray_work;                         ///< nothing where not counted
  std::optional<ShadowCosts> shadow_costs;  ///< made when it is written; none: not timed
};

struct LightLists {
  std::array<std::uint64_t, class_count> classes{};  ///< acne … remap; they sum to error.wrong
  /// Mean |V6 - V0| of the pixels with each label, over all compared ones; they sum to error.mean_absolute but for
  /// errors below least_labelled_error.
  std::array<double, class_count> class_errors{};
  std::array<double, rung_count> rung_mean{};  ///< mean visibility over compared pixels, V0 … V6
  std::vector<CascadeFigures> cascades;        ///< of technique csm, the finest first; else empty
  std::vector<BiasCurvePoint>
      bias_curve;  ///< empty where the drawing does not say what another bias would draw
  std::string_view bias_curve_withheld;   ///< why, as a sentence; else empty
  std::vector<BiasKind> bias_kinds;       ///< the best first; empty where not made
  std::vector<OtherMapSize> other_sizes;  ///< the smallest first; empty where not estimated
};

/// The rungs of every pixel, and its label.
struct Climb {
  /// 1 lit, 0 shadowed, between: soft or filtered; 1 where not climbed (ladder/ladder.h)
  std::array<Image<float>, rung_count> rungs;
  Image<Label> labels;  ///< of every error of least_labelled_error and more, of one half and less, too
};

/// What is measured of a pixel with those around it; empty without MeasureOptions::perceptual.
struct MetricMaps {
  Image<float> edge_map;  ///< displacement of shadow edges in texels; NaN where there is none
  Image<float> flip_map;
  Image<float> ssim_map;  ///< of each window by its middle pixel; NaN where no window fits
};

struct LightImages : Climb, MetricMaps {
  Image<float> detachment_map;  ///< world units (edges.h); NaN where there is none, empty where not made
  Image<std::uint32_t>
      stored_glass;  ///< shown_materials.h; empty where no material is glass, and where not made
};

/// Of V6 - V0 as a mean over several places in each pixel, where all else is at its centre (measure/subpixels.h).
struct SubpixelFigures {
  int places = 0;               ///< in each pixel
  std::uint64_t pixels = 0;     ///< with a place that could be compared; silhouettes are among them
  double mean_absolute = 0.0;   ///< of the pixels' means
  double wrong_fraction = 0.0;  ///< of pixels whose mean is off by more than one half
  double unknown = 0.0;         ///< the share of places on surfaces that could not be compared
};

struct LightComparison : LightFigures, LightLists, LightImages {
  std::uint32_t light = 0;  ///< index in Scene::lights
  std::size_t record = 0;   ///< index in RasterFrame::lights and RayTracedFrame::lights
  Times classify;
  std::optional<SubpixelFigures> subpixel;  ///< where it was asked for
};

/// Makes unknown (NaN) what is counted in texels, where there is no map, or it is not known.
void forget_texels(LightComparison& light);
/// Edges are not counted in texels where there is no map. Nor are they where the pictures differ but no edge was found in both.
/// A shadow that is blurred until no edge is left is not right to the texel.
void forget_unknown_edges(LightFigures& light, bool has_map);

/// A smaller error has no label: not even a picture of eight bits shows it.
inline constexpr float least_labelled_error = 1.0f / 255.0f;
/// Whether what is drawn is off enough to be charged to a cause.
inline bool has_error(float drawn, float truth) {
  return std::abs(drawn - truth) >= least_labelled_error;
}
/// Whether V6 is off V0 by more than one half.
inline bool is_wrong(const std::array<float, rung_count>& rungs) {
  return std::abs(rungs[6] - rungs[0]) > 0.5f;
}

/// A pixel's rungs.
inline std::array<float, rung_count> rungs_at(const std::array<Image<float>, rung_count>& rungs,
                                              std::size_t pixel) {
  std::array<float, rung_count> v{};
  for (std::size_t k = 0; k < rung_count; ++k) v[k] = rungs[k].data[pixel];
  return v;
}

struct MachineInfo {
  std::string cpu, os;
  int cores = 0;
  /// Threads that ran or waited for a core, this program's included, the mean of the last minute; none where the system does
  /// not say.
  std::optional<double> load = std::nullopt;
};

struct Judged;

/// A setting beside the one compared that was drawn, so that it can be advised (advice/tried.h).
struct TriedSetting {
  raster::MapOptions map;
  std::vector<LightFigures> lights;  ///< as RasterFrame::lights; pixels, error and edges alone
};

inline constexpr std::string_view rates_schema = "gnomon/rates/1";

/// What a machine does in a second, as a person measured it or looked it up; 0: not given.
struct Rates {
  std::string name, source;
  double texels = 0.0;   ///< of a depth map, drawn
  double lookups = 0.0;  ///< of a map, compared
  double rays = 0.0;     ///< to a light, traced
  double taps = 0.0;     ///< of a denoiser, read
};

struct Comparison {
  const World* world = nullptr;
  /// Another renderer's picture and map stand in `raster` (compare/result/judged.h); null: Gnomon's own.
  std::shared_ptr<const Judged> judged;
  std::string command;  ///< as the user could type it again
  std::uint64_t seed = 0;
  int threads = 0;
  MachineInfo machine;
  EffectPlan plan;
  raytrace::Precision precision = raytrace::Precision::robust;  ///< of the ray tracer
  raster::RasterFrame raster;
  raytrace::RayTracedFrame raytraced;
  /// Stands for the receivers of a picture in bands, which are not kept; else empty.
  Image<SeenSurface> seen;
  std::vector<LightComparison> lights;
  std::vector<TriedSetting> tried;  ///< empty where nothing was worth a drawing, and where none was made
  ViewErrors views;
  const Figure* measure = &wrong_and_mean();  ///< what errors are counted in, where the user chose
  std::optional<ShadedError> shaded;    ///< none: not made, or rays draw more than shadows (measure/shaded.h)
  std::optional<Rates> rates;           ///< of a machine that is not here
  std::optional<Threshold> fail_above;  ///< what the errors were held against
  double exposure = 1.0;                ///< linear factor applied to both pictures before sRGB encoding
  double load_ms = 0.0, topology_ms = 0.0, report_ms = 0.0, total_ms = 0.0;
  std::uint64_t peak_memory_bytes = 0;
};

}  // namespace gnomon::compare
