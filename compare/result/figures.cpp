#include "compare/result/figures.h"

#include <algorithm>
#include <cmath>

#include "compare/comparison.h"
#include "compare/ladder/budget.h"
#include "compare/result/number_text.h"

namespace gnomon::compare {
namespace figure_rows {

constexpr double not_made = std::numeric_limits<double>::quiet_NaN();

template <class T>
constexpr bool is_optional = requires(T block) {
  block.has_value();
};

/// A field of a block of LightFigures.
template <auto block, auto field>
constexpr FigurePlace at() {
  using Block = std::remove_cvref_t<decltype(std::declval<LightFigures>().*block)>;
  if constexpr (is_optional<Block>) {
    using Number = std::remove_cvref_t<decltype((*std::declval<Block>()).*field)>;
    return {
        [](const LightFigures& light) { return light.*block ? double(*(light.*block).*field) : not_made; },
        [](LightFigures& light, double value) {
          if (!(light.*block)) (light.*block).emplace();
          *(light.*block).*field = static_cast<Number>(value);
        },
        std::is_integral_v<Number> ? FigureForm::count : FigureForm::number, true};
  } else {
    using Number = std::remove_cvref_t<decltype(std::declval<Block>().*field)>;
    return {[](const LightFigures& light) { return double((light.*block).*field); },
            [](LightFigures& light, double value) { (light.*block).*field = static_cast<Number>(value); },
            std::is_integral_v<Number> ? FigureForm::count : FigureForm::number};
  }
}

constexpr FigurePlace percentage(FigurePlace place) {
  place.form = FigureForm::percent;
  return place;
}

double ratio(double part, double whole) {
  return whole > 0.0 ? part / whole : not_made;
}

using L = LightFigures;

template <std::size_t i>
double texel_width(const L& light) {
  return light.texel_world[i];
}

/// Not made where no receiver has a texel.
template <auto field>
double detached_texels(const L& light) {
  return ratio(light.detachment.*field, light.texel_world[1]);
}

template <auto field>
double tests_per_ray(const L& light) {
  return ratio(double(light.ray_work.*field), double(light.ray_work.rays));
}

double compared(const L& light) {
  return double(light.pixels.compared);
}

/// Of what shadows cost: milliseconds, not made where not timed.
template <auto situation, auto side, auto part>
constexpr FigurePlace cost() {
  return {.get =
              [](const L& light) {
                if (!light.shadow_costs) return not_made;
                const TimeDifference& ms = (*light.shadow_costs).*situation.*side;
                return ms.timed() ? ms.*part : not_made;
              },
          .optional = true};
}

double edge_count(const L& light) {
  return double(light.edges.edges);
}

/// Not made where the technique looks up no map, or a shader of the user's own does.
double lookups(const L& light) {
  return light.lookups ? double(*light.lookups) : not_made;
}

double lookups_per_pixel(const L& light) {
  return lookups(light) / std::max(compared(light), 1.0);
}

double share_of_filter(const L& light) {
  const double filter = light.budget[static_cast<std::size_t>(Cause::filter)].absolute_mean;
  return filter > 0.0 ? light.bleeding.mean / filter : 0.0;
}

double wrong_fraction(const L& light) {
  return wrong_share(light.error.wrong, light.error.ties, light.pixels.compared);
}

double larger_of_both(const L& light) {
  return std::max(light.error.wrong_fraction, light.error.mean_absolute);
}

double flips_per_second(const L& light) {
  const ShimmerFigures& film = *light.shimmer;
  return film.fps * (double(film.flips) / double(std::max<std::uint64_t>(film.receiver_steps, 1)));
}

using P = PixelCounts;
using E = ErrorStats;
using D = Detachment;
using S = PenumbraStats;
using F = ShimmerFigures;
constexpr auto film = &L::shimmer;
constexpr auto pixels = &L::pixels;
constexpr auto error = &L::error;
constexpr auto edges = &L::edges;
constexpr auto detachment = &L::detachment;
constexpr auto bleeding = &L::bleeding;
constexpr auto soft = &L::penumbra;
using C = ShadowCosts;
using Sides = ShadowCosts::Sides;
using T = TimeDifference;
using enum Better;
using Kind = Pooling::Kind;
constexpr Pooling none{}, sum{Kind::sum}, same{Kind::same};
constexpr Pooling mean{Kind::mean, compared}, rms{Kind::root_mean_square, compared};
constexpr auto in_table = Figure::Table::sweep;
constexpr auto perception = FigureNeeds::perception;

// Those of a film come first, as a sweep's table has them.
constexpr Figure rows[] = {
    {"shimmer.frames", "frames", at<film, &F::frames>()},
    {"shimmer.fps", "per second", at<film, &F::fps>(), neither, same, "frames per second"},
    {"shimmer.receiver_steps", "receivers", at<film, &F::receiver_steps>(), neither, sum},
    {"shimmer.flips", "receivers", at<film, &F::flips>(), less, sum},
    {.key = "shimmer.flips_per_receiver_second",
     .unit = "flips per receiver and second",
     .place = at<film, &F::flips_per_receiver_second>(),
     .better = less,
     .pooling = {Kind::derived, flips_per_second},
     .words = "flips per receiver and second",
     .table = in_table,
     .needs = FigureNeeds::film,
     .measure = {"shimmer", "{} flips per receiver and second", "at most {} flips per receiver and second",
                 "{} flips per receiver and second", "0.1", "1e9"}},
    {"shimmer.mean_absolute", "share", at<film, &F::mean_absolute>(), less, none, "mean temporal error"},

    {"pixels.total", "pixels", at<pixels, &P::total>()},
    {"pixels.background", "pixels", at<pixels, &P::background>()},
    {"pixels.facing_away", "pixels", at<pixels, &P::facing_away>()},
    {"pixels.silhouette", "pixels", at<pixels, &P::silhouette>()},
    {"pixels.uncertain", "pixels", at<pixels, &P::uncertain>(), less, sum},
    {"pixels.uncertain_by_samples", "pixels", at<pixels, &P::uncertain_by_samples>(), less, sum},
    {"pixels.compared", "pixels", at<pixels, &P::compared>(), neither, sum},

    {"error.wrong", "pixels", at<error, &E::wrong>(), less, sum, "wrong pixels"},
    {.key = "error.wrong_fraction",
     .unit = "share",
     .place = percentage(at<error, &E::wrong_fraction>()),
     .better = less,
     .pooling = {Kind::derived, wrong_fraction},
     .words = "wrong",
     .table = in_table,
     .measure = {"wrong", "{} wrong", "at most {} wrong", "{} wrong", "1%", "", true},
     .mark = {"wrong", "wrong pixels"}},
    {.key = "error.false_shadow",
     .unit = "pixels",
     .place = at<error, &E::false_shadow>(),
     .better = less,
     .pooling = sum,
     .table = in_table,
     .mark = {"false_shadow", "false shadows"}},
    {.key = "error.missed_shadow",
     .unit = "pixels",
     .place = at<error, &E::missed_shadow>(),
     .better = less,
     .pooling = sum,
     .table = in_table,
     .mark = {"missed_shadow", "missed shadows"}},
    {"error.ties", "pixels", at<error, &E::ties>(), less, sum, "off by exactly one half"},
    {"error.fractional", "pixels", at<error, &E::fractional>()},
    {.key = "error.mean_absolute",
     .unit = "share",
     .place = percentage(at<error, &E::mean_absolute>()),
     .better = less,
     .pooling = mean,
     .words = "mean error",
     .table = in_table,
     .measure = {"mean", "mean error {}", "a mean error of at most {}", "a mean error of {}", "0.5%"},
     .mark = {"mean_error", "a mean error"},
     .in_summary = "mean "},
    {.key = "error.rms",
     .unit = "share",
     .place = at<error, &E::rms>(),
     .better = less,
     .pooling = rms,
     .words = "RMS error",
     .table = in_table,
     .in_summary = ", RMS "},
    {.key = "error.flip",
     .unit = "share",
     .place = at<error, &E::flip>(),
     .better = less,
     .pooling = mean,
     .words = "FLIP",
     .table = in_table,
     .needs = perception,
     .measure = {"flip", "mean FLIP {}", "a mean FLIP of at most {}", "a mean FLIP of {}", "0.05"},
     .in_summary = "; FLIP "},
    {"error.ssim", "share", at<error, &E::ssim>(), more, mean, "SSIM", in_table, perception},
    {.key = "error.flip_compared",
     .unit = "share",
     .place = at<error, &E::flip_compared>(),
     .better = less,
     .words = "FLIP of compared pixels",
     .needs = perception,
     .in_summary = ", over compared pixels alone "},
    {"error.ssim_compared", "share", at<error, &E::ssim_compared>(), more, none, "SSIM of compared pixels"},

    {"right_by_accident.shadowed", "pixels", at<&L::accidents, &RightByAccident::shadowed>()},
    {"right_by_accident.lit", "pixels", at<&L::accidents, &RightByAccident::lit>()},

    {"seams.at_border", "receivers", at<&L::seams, &SeamCount::at_border>()},
    {"seams.changed", "receivers", at<&L::seams, &SeamCount::changed>(), less},

    {"outside_map.receivers", "pixels", at<&L::outside, &OutsideMap::receivers>()},
    {"outside_map.shadowed", "pixels", at<&L::outside, &OutsideMap::shadowed>(), less},
    {"outside_map.drawn_dark", "pixels", at<&L::outside, &OutsideMap::drawn_dark>()},

    {"terminator.dark", "pixels", at<&L::terminator, &TerminatorCount::dark>()},
    {"terminator.unlit", "pixels", at<&L::terminator, &TerminatorCount::unlit>()},

    {"detachment.pixels", "pixels", at<detachment, &D::pixels>(), less},
    {"detachment.mean_world", "world units", at<detachment, &D::mean_world>(), less},
    {"detachment.max_world", "world units", at<detachment, &D::max_world>(), less},
    {"detachment.rms_world", "world units", at<detachment, &D::rms_world>(), less},
    {.key = "detachment.mean_texels",
     .unit = "texels",
     .place = {detached_texels<&D::mean_world>},
     .better = less,
     .mark = {"detachment", "shadows that start too far away"}},
    {"detachment.max_texels", "texels", {detached_texels<&D::max_world>}, less},

    {"edges.count", "edges", at<edges, &EdgeStats::edges>(), neither, sum},
    {"edges.mean_texels", "texels", at<edges, &EdgeStats::mean_texels>()},
    {.key = "edges.rms_texels",
     .unit = "texels",
     .place = at<edges, &EdgeStats::rms_texels>(),
     .better = less,
     .pooling = {Kind::root_mean_square, edge_count},
     .words = "edge error",
     .table = in_table,
     .needs = FigureNeeds::edges,
     .measure = {"edge", "edges off by {} (RMS)", "shadow edges displaced by at most {} (RMS)",
                 "{} of displacement", "0.5texel", "1e6"},
     .mark = {"edge", "shadow edges off their place (root mean square)"}},
    {"edges.rms_pixels", "pixels", at<edges, &EdgeStats::rms_pixels>(), less},
    {"edges.mean_absolute_texels", "texels", at<edges, &EdgeStats::mean_absolute_texels>(), less},
    {"edges.mean_world", "world units", at<edges, &EdgeStats::mean_world>()},
    {"edges.mean_absolute_world", "world units", at<edges, &EdgeStats::mean_absolute_world>(), less},
    {"edges.rms_world", "world units", at<edges, &EdgeStats::rms_world>(), less},

    {"bleeding.pixels", "pixels", at<bleeding, &BleedingStats::pixels>(), less},
    {"bleeding.mean", "share", at<bleeding, &BleedingStats::mean>(), less},
    {"bleeding.max", "share", at<bleeding, &BleedingStats::max>(), less},
    {"bleeding.share_of_filter", "share", {share_of_filter}},

    {"penumbra.edges", "edges", at<soft, &S::edges>()},
    {"penumbra.true_penumbra_world", "world units", at<soft, &S::true_penumbra_world>()},
    {"penumbra.drawn_penumbra_world", "world units", at<soft, &S::drawn_penumbra_world>()},
    {"penumbra.umbra_edges", "edges", at<soft, &S::umbra_edges>()},
    {"penumbra.true_umbra_world", "world units", at<soft, &S::true_umbra_world>()},
    {"penumbra.drawn_umbra_world", "world units", at<soft, &S::drawn_umbra_world>()},
    {"penumbra.true_umbra_pixels", "pixels", at<soft, &S::true_umbra_pixels>()},
    {"penumbra.true_penumbra_pixels", "pixels", at<soft, &S::true_penumbra_pixels>()},
    {"penumbra.drawn_umbra_pixels", "pixels", at<soft, &S::drawn_umbra_pixels>()},
    {"penumbra.drawn_penumbra_pixels", "pixels", at<soft, &S::drawn_penumbra_pixels>()},
    {"penumbra.standard_error_mean", "share", at<soft, &S::standard_error_mean>(), less},
    {"penumbra.standard_error_max", "share", at<soft, &S::standard_error_max>(), less},

    {"map.texel_world.min", "world units", {texel_width<0>}},
    {"map.texel_world.median", "world units", {texel_width<1>}},
    {"map.texel_world.max", "world units", {texel_width<2>}},

    {"lookups.total", "lookups", {lookups, nullptr, FigureForm::count}},
    {"lookups.per_pixel", "lookups", {lookups_per_pixel}},
    {"ray_tests.rays", "rays", at<&L::ray_work, &RayWork::rays>()},
    {"ray_tests.boxes_per_ray", "boxes", {tests_per_ray<&RayWork::boxes>}},
    {"ray_tests.primitives_per_ray", "primitives", {tests_per_ray<&RayWork::primitives>}},

    {"times_ms.shadows.nothing_moves_map", "ms", cost<&C::nothing_moves, &Sides::map, &T::median>(), less},
    {"times_ms.shadows.nothing_moves_map_low", "ms", cost<&C::nothing_moves, &Sides::map, &T::low>(), less},
    {"times_ms.shadows.nothing_moves_map_high", "ms", cost<&C::nothing_moves, &Sides::map, &T::high>(), less},
    {"times_ms.shadows.nothing_moves_rays", "ms", cost<&C::nothing_moves, &Sides::rays, &T::median>(), less},
    {"times_ms.shadows.nothing_moves_rays_low", "ms", cost<&C::nothing_moves, &Sides::rays, &T::low>(), less},
    {"times_ms.shadows.nothing_moves_rays_high", "ms", cost<&C::nothing_moves, &Sides::rays, &T::high>(),
     less},
    {"times_ms.shadows.light_moves_map", "ms", cost<&C::light_moves, &Sides::map, &T::median>(), less},
    {"times_ms.shadows.light_moves_map_low", "ms", cost<&C::light_moves, &Sides::map, &T::low>(), less},
    {"times_ms.shadows.light_moves_map_high", "ms", cost<&C::light_moves, &Sides::map, &T::high>(), less},
    {"times_ms.shadows.light_moves_rays", "ms", cost<&C::light_moves, &Sides::rays, &T::median>(), less},
    {"times_ms.shadows.light_moves_rays_low", "ms", cost<&C::light_moves, &Sides::rays, &T::low>(), less},
    {"times_ms.shadows.light_moves_rays_high", "ms", cost<&C::light_moves, &Sides::rays, &T::high>(), less},
    {"times_ms.shadows.casters_move_map", "ms", cost<&C::casters_move, &Sides::map, &T::median>(), less},
    {"times_ms.shadows.casters_move_map_low", "ms", cost<&C::casters_move, &Sides::map, &T::low>(), less},
    {"times_ms.shadows.casters_move_map_high", "ms", cost<&C::casters_move, &Sides::map, &T::high>(), less},
    {"times_ms.shadows.casters_move_rays", "ms", cost<&C::casters_move, &Sides::rays, &T::median>(), less},
    {"times_ms.shadows.casters_move_rays_low", "ms", cost<&C::casters_move, &Sides::rays, &T::low>(), less},
    {"times_ms.shadows.casters_move_rays_high", "ms", cost<&C::casters_move, &Sides::rays, &T::high>(), less},
};

/// No key of its own.
constexpr Figure both{
    .key = "",
    .unit = "share",
    .place = {larger_of_both, nullptr, FigureForm::percent},
    .measure = {"wrong and mean", "", "at most {} wrong, and a mean error of at most as much",
                "an error of {}", "1%", "", true}};

}  // namespace figure_rows

namespace {

double pooled_value(const Figure& figure, std::span<const LightFigures> lights, const LightFigures& pooled) {
  using enum Pooling::Kind;
  const auto& [kind, function] = figure.pooling;
  if (kind == derived) return function(pooled);
  if (kind == same) return figure.of(lights.back());
  double all = 0.0, weights = 0.0;
  for (const LightFigures& light : lights) {
    const double value = figure.of(light), weight = kind == sum ? 1.0 : function(light);
    all += kind == root_mean_square ? weight * value * value : weight * value;
    weights += weight;
  }
  if (kind == sum) return all;
  all /= std::max(weights, 1.0);
  return kind == root_mean_square ? std::sqrt(all) : all;
}

}  // namespace

std::span<const Figure> figures() {
  return figure_rows::rows;
}

LightFigures pool_lights(std::span<const LightFigures> lights) {
  LightFigures pooled;
  for (const bool derived : {false, true})
    for (const Figure& figure : figures()) {
      const Pooling::Kind kind = figure.pooling.kind;
      if (kind == Pooling::Kind::none || (kind == Pooling::Kind::derived) != derived) continue;
      if (figure.place.optional && std::isnan(figure.of(derived ? pooled : lights.back()))) continue;
      figure.place.set(pooled, pooled_value(figure, lights, pooled));
    }
  return pooled;
}

const Figure& wrong_and_mean() {
  return figure_rows::both;
}

const Figure* find_measure(std::string_view name) {
  for (const Figure& figure : figures())
    if (!name.empty() && figure.measure.name == name) return &figure;
  return nullptr;
}

std::string_view form_name(FigureForm form) {
  return form == FigureForm::count ? "count" : form == FigureForm::percent ? "percent" : "number";
}

std::string figure_name(const Figure& figure) {
  std::string words(figure.words.empty() ? figure.name() : figure.words);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string measure_words(const Figure& measure) {
  return measure.measure.by_halves ? std::string(measure.mark.words) : figure_name(measure);
}

std::string figure_head(const Figure& figure) {
  return figure_name(figure) + (figure.unit == "texels" ? ", texels" : "");
}

std::string figure_text(const Figure& figure, double value) {
  if (figure.form() == FigureForm::count) return grouped(static_cast<std::uint64_t>(value));
  if (figure.form() == FigureForm::percent) return percent(value);
  return figure.unit == "texels" ? texels_text(value) : plain_number(value);
}

}  // namespace gnomon::compare
