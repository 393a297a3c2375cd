// The rows of figures.h.
#include "compare/result/figures.h"

#include <algorithm>
#include <limits>

#include "compare/comparison.h"
#include "compare/ladder/budget.h"

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

constexpr FigurePlace from(double least, FigurePlace place) {
  place.least = least;
  return place;
}

constexpr FigurePlace up_to(double most, FigurePlace place) {
  place.most = most;
  return place;
}

/// Both signs have a meaning.
constexpr FigurePlace with_sign(FigurePlace place) {
  return from(-FigurePlace{}.most, place);
}

constexpr FigurePlace or_null(FigurePlace place) {
  place.nullable = true;
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
  if (!light.bleeding) return not_made;
  return filter > 0.0 ? light.bleeding->mean / filter : 0.0;
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
    {"shimmer.frames", "frames", "of the film", from(2.0, at<film, &F::frames>())},
    {"shimmer.fps", "per second", "frames a second", at<film, &F::fps>(), neither, same, "frames per second"},
    {"shimmer.receiver_steps", "receivers",
     "receivers compared in two following frames, over all pairs of them", at<film, &F::receiver_steps>(),
     neither, sum},
    {"shimmer.flips", "receivers", "of them those whose temporal error is more than one half",
     at<film, &F::flips>(), less, sum},
    {.key = "shimmer.flips_per_receiver_second",
     .unit = "flips per receiver and second",
     .describes = "flips / receiver_steps * fps",
     .place = at<film, &F::flips_per_receiver_second>(),
     .better = less,
     .pooling = {Kind::derived, flips_per_second},
     .words = "flips per receiver and second",
     .table = in_table,
     .needs = FigureNeeds::film,
     .measure = {"shimmer", "{} flips per receiver and second", "at most {} flips per receiver and second",
                 "{} flips per receiver and second", "0.1", "1e9"}},
    {"shimmer.mean_absolute", "share", "mean size of the temporal error", at<film, &F::mean_absolute>(), less,
     none, "mean temporal error"},

    {"pixels.total", "pixels", "all pixels", at<pixels, &P::total>()},
    {"pixels.background", "pixels", "no surface", at<pixels, &P::background>()},
    {"pixels.facing_away", "pixels", "n.l <= 0, or outside the spot's cone", at<pixels, &P::facing_away>()},
    {"pixels.silhouette", "pixels", "the two renderers see different primitives",
     at<pixels, &P::silhouette>()},
    {"pixels.uncertain", "pixels",
     "the truth is within its own error bound: a ray that cannot be decided, or a light with size seen by "
     "one half within the standard error of its samples",
     at<pixels, &P::uncertain>(), less, sum},
    {"pixels.uncertain_by_samples", "pixels",
     "of the uncertain ones those that only the samples of a light with size leave in doubt",
     at<pixels, &P::uncertain_by_samples>(), less, sum},
    {"pixels.compared", "pixels", "all others", at<pixels, &P::compared>(), neither, sum},

    {"error.wrong", "pixels", "compared pixels with |V6 - V0| > 0.5; false_shadow + missed_shadow",
     at<error, &E::wrong>(), less, sum, "wrong pixels"},
    {.key = "error.wrong_fraction",
     .unit = "share",
     .describes = "(wrong + ties / 2) / compared; 0 when nothing is compared",
     .place = percentage(at<error, &E::wrong_fraction>()),
     .better = less,
     .pooling = {Kind::derived, wrong_fraction},
     .words = "wrong",
     .table = in_table,
     .measure = {"wrong", "{} wrong", "at most {} wrong", "{} wrong", "1%", "", true},
     .mark = {"wrong", "wrong pixels"}},
    {.key = "error.false_shadow",
     .unit = "pixels",
     .describes = "V6 - V0 < -0.5",
     .place = at<error, &E::false_shadow>(),
     .better = less,
     .pooling = sum,
     .table = in_table,
     .mark = {"false_shadow", "false shadows"}},
    {.key = "error.missed_shadow",
     .unit = "pixels",
     .describes = "V6 - V0 > 0.5",
     .place = at<error, &E::missed_shadow>(),
     .better = less,
     .pooling = sum,
     .table = in_table,
     .mark = {"missed_shadow", "missed shadows"}},
    {"error.ties", "pixels",
     "compared pixels with |V6 - V0| = 0.5 exactly: neither right nor wrong, and in no class",
     at<error, &E::ties>(), less, sum, "off by exactly one half"},
    {"error.fractional", "pixels",
     "compared pixels with V0 or V6 between 0 and 1; where there are none, the mean error is the share of "
     "wrong pixels",
     at<error, &E::fractional>()},
    {.key = "error.mean_absolute",
     .unit = "share",
     .describes = "mean of |V6 - V0|",
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
     .describes = "root of the mean of (V6 - V0)^2",
     .place = at<error, &E::rms>(),
     .better = less,
     .pooling = rms,
     .words = "RMS error",
     .table = in_table,
     .in_summary = ", RMS "},
    {.key = "error.flip",
     .unit = "share",
     .describes = "mean LDR-FLIP (Andersson et al. 2020) of the drawn against the true visibility; null when "
                  "a sweep did not ask for it",
     .place = or_null(at<error, &E::flip>()),
     .better = less,
     .pooling = mean,
     .words = "FLIP",
     .table = in_table,
     .needs = perception,
     .measure = {"flip", "mean FLIP {}", "a mean FLIP of at most {}", "a mean FLIP of {}", "0.05"},
     .in_summary = "; FLIP "},
    {"error.ssim", "share",
     "mean SSIM (Wang et al. 2004) of the drawn against the true visibility; null when a sweep did not ask "
     "for it, or in a picture smaller than its window of 11x11 pixels",
     or_null(with_sign(at<error, &E::ssim>())), more, mean, "SSIM", in_table, perception},
    {.key = "error.flip_compared",
     .unit = "share",
     .describes = "flip over the compared pixels alone; null where there are none too",
     .place = or_null(at<error, &E::flip_compared>()),
     .better = less,
     .words = "FLIP of compared pixels",
     .needs = perception,
     .in_summary = ", over compared pixels alone "},
    {"error.ssim_compared", "share",
     "ssim over the windows around compared pixels alone; null where there are none too",
     or_null(with_sign(at<error, &E::ssim_compared>())), more, none, "SSIM of compared pixels"},

    {"right_by_accident.shadowed", "pixels",
     "truly shadowed, the texel's centre lit: dark only because the surface shadows itself",
     at<&L::accidents, &RightByAccident::shadowed>()},
    {"right_by_accident.lit", "pixels",
     "truly lit, the texel's centre shadowed: lit only because bias or filter let light past the stored "
     "caster",
     at<&L::accidents, &RightByAccident::lit>()},

    {"seams.at_border", "receivers",
     "compared receivers beside whose pixel the same surface looks up another cascade or face",
     at<&L::seams, &SeamCount::at_border>()},
    {"seams.changed", "receivers",
     "of them those that the other one would draw on the other side of one half: their visibility changes "
     "only because their cascade or face does",
     at<&L::seams, &SeamCount::changed>(), less},

    {"outside_map.receivers", "pixels", "such pixels", at<&L::outside, &OutsideMap::receivers>()},
    {"outside_map.shadowed", "pixels", "of them those truly in shadow, for the larger part",
     at<&L::outside, &OutsideMap::shadowed>(), less},
    {"outside_map.drawn_dark", "pixels", "of them those drawn in shadow, for the larger part",
     at<&L::outside, &OutsideMap::drawn_dark>()},

    {"terminator.dark", "pixels", "pixels of facing_away whose smooth normal faces the light",
     at<&L::terminator, &TerminatorCount::dark>()},
    {"terminator.unlit", "pixels",
     "compared pixels whose smooth normal faces away: black by their shading, whatever shadows say",
     at<&L::terminator, &TerminatorCount::unlit>()},

    {"detachment.pixels", "pixels", "pixels that the bias lets light through to",
     at<detachment, &D::pixels>(), less},
    {"detachment.mean_world", "world units", "world units", at<detachment, &D::mean_world>(), less},
    {"detachment.max_world", "world units", "world units", at<detachment, &D::max_world>(), less},
    {"detachment.rms_world", "world units", "world units", at<detachment, &D::rms_world>(), less},
    {.key = "detachment.mean_texels",
     .unit = "texels",
     .describes = "in texels of the median width; null where no receiver is compared",
     .place = or_null(FigurePlace{detached_texels<&D::mean_world>}),
     .better = less,
     .mark = {"detachment", "shadows that start too far away"}},
    {"detachment.max_texels", "texels", "the same", or_null(FigurePlace{detached_texels<&D::max_world>}),
     less},

    {"edges.count", "edges", "pixel pairs across true shadow edges that were measured",
     at<edges, &EdgeStats::edges>(), neither, sum},
    {"edges.mean_texels", "texels",
     "signed; positive where the drawn shadow is larger; the three are null without a map, and where the "
     "pictures differ but no "
     "edge was found in both",
     or_null(with_sign(at<edges, &EdgeStats::mean_texels>()))},
    {.key = "edges.rms_texels",
     .unit = "texels",
     .describes = "texels",
     .place = or_null(at<edges, &EdgeStats::rms_texels>()),
     .better = less,
     .pooling = {Kind::root_mean_square, edge_count},
     .words = "edge error",
     .table = in_table,
     .needs = FigureNeeds::edges,
     .measure = {"edge", "edges off by {} (RMS)", "shadow edges displaced by at most {} (RMS)",
                 "{} of displacement", "0.5texel", "1e6"},
     .mark = {"edge", "shadow edges off their place (root mean square)"}},
    {"edges.rms_pixels", "pixels", "pixels", at<edges, &EdgeStats::rms_pixels>(), less},
    {"edges.mean_absolute_texels", "texels", "texels", or_null(at<edges, &EdgeStats::mean_absolute_texels>()),
     less},
    {"edges.mean_world", "world units", "world units along the receiver; signed",
     with_sign(at<edges, &EdgeStats::mean_world>())},
    {"edges.mean_absolute_world", "world units", "world units", at<edges, &EdgeStats::mean_absolute_world>(),
     less},
    {"edges.rms_world", "world units", "world units", at<edges, &EdgeStats::rms_world>(), less},

    {"bleeding.pixels", "pixels", "such pixels", at<bleeding, &BleedingStats::pixels>(), less},
    {"bleeding.mean", "share",
     "mean of V6 - V5 on them, over all compared pixels; signed and absolute are the same",
     at<bleeding, &BleedingStats::mean>(), less},
    {"bleeding.max", "share", "largest V6 - V5", at<bleeding, &BleedingStats::max>(), less},
    {"bleeding.share_of_filter", "share",
     "mean over the filter step's absolute mean; 0 without a filter step; above 1 by rounding alone",
     up_to(1.0001, {.get = share_of_filter, .optional = true})},

    {"penumbra.edges", "edges", "of the penumbra widths", at<soft, &S::edges>()},
    {"penumbra.true_penumbra_world", "world units", "median width", at<soft, &S::true_penumbra_world>()},
    {"penumbra.drawn_penumbra_world", "world units", "median width", at<soft, &S::drawn_penumbra_world>()},
    {"penumbra.umbra_edges", "edges", "of the umbra widths", at<soft, &S::umbra_edges>()},
    {"penumbra.true_umbra_world", "world units", "median width", at<soft, &S::true_umbra_world>()},
    {"penumbra.drawn_umbra_world", "world units", "median width", at<soft, &S::drawn_umbra_world>()},
    {"penumbra.true_umbra_pixels", "pixels",
     "pixels that see nothing of the light, of those that are compared and those that only its samples leave "
     "uncertain (pixels.uncertain_by_samples)",
     at<soft, &S::true_umbra_pixels>()},
    {"penumbra.true_penumbra_pixels", "pixels", "of the same pixels those that see a part of it",
     at<soft, &S::true_penumbra_pixels>()},
    {"penumbra.drawn_umbra_pixels", "pixels", "the same as drawn", at<soft, &S::drawn_umbra_pixels>()},
    {"penumbra.drawn_penumbra_pixels", "pixels", "the same as drawn", at<soft, &S::drawn_penumbra_pixels>()},
    {"penumbra.standard_error_mean", "share",
     "of the truth's samples of the light, estimated from them, over compared pixels that see a part of it",
     at<soft, &S::standard_error_mean>(), less},
    {"penumbra.standard_error_max", "share", "the largest of them", at<soft, &S::standard_error_max>(), less},
    {"penumbra.weighted_difference", "share",
     "how far the share of the unshadowed light that arrives lies from V0, the share of the light that is "
     "seen, on average where a "
     "part is seen; null where not measured",
     or_null(at<soft, &S::weighted_difference>()), less},

    {"map.texel_world.min", "world units", "smallest", or_null(FigurePlace{texel_width<0>})},
    {"map.texel_world.median", "world units", "median", or_null(FigurePlace{texel_width<1>})},
    {"map.texel_world.max", "world units", "largest", or_null(FigurePlace{texel_width<2>})},

    {"lookups.total", "lookups", "counted by the shader",
     or_null(FigurePlace{lookups, nullptr, FigureForm::count})},
    {"lookups.per_pixel", "lookups", "total over the compared pixels",
     or_null(FigurePlace{lookups_per_pixel})},
    {"ray_tests.rays", "rays", "counted; 0 in sweeps", at<&L::ray_work, &RayWork::rays>()},
    {"ray_tests.boxes_per_ray", "boxes", "boxes or cells tested",
     or_null(FigurePlace{tests_per_ray<&RayWork::boxes>})},
    {"ray_tests.primitives_per_ray", "primitives", "triangles and shapes tested",
     or_null(FigurePlace{tests_per_ray<&RayWork::primitives>})},

    {"times_ms.shadows.nothing_moves_map", "ms",
     "milliseconds where nothing has moved since the last frame: what looking the map up adds to the "
     "shading; null when not timed",
     or_null(cost<&C::nothing_moves, &Sides::map, &T::median>()), less},
    {"times_ms.shadows.nothing_moves_map_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::nothing_moves, &Sides::map, &T::low>()), less},
    {"times_ms.shadows.nothing_moves_map_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::nothing_moves, &Sides::map, &T::high>()), less},
    {"times_ms.shadows.nothing_moves_rays", "ms",
     "milliseconds where nothing has moved since the last frame: the rays; null when not timed",
     or_null(cost<&C::nothing_moves, &Sides::rays, &T::median>()), less},
    {"times_ms.shadows.nothing_moves_rays_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::nothing_moves, &Sides::rays, &T::low>()), less},
    {"times_ms.shadows.nothing_moves_rays_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::nothing_moves, &Sides::rays, &T::high>()), less},
    {"times_ms.shadows.light_moves_map", "ms",
     "milliseconds where the light or the camera has moved: drawing the map, and looking it up; null when "
     "not timed",
     or_null(cost<&C::light_moves, &Sides::map, &T::median>()), less},
    {"times_ms.shadows.light_moves_map_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::light_moves, &Sides::map, &T::low>()), less},
    {"times_ms.shadows.light_moves_map_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::light_moves, &Sides::map, &T::high>()), less},
    {"times_ms.shadows.light_moves_rays", "ms",
     "milliseconds where the light or the camera has moved: the rays; their tree stands; null when not timed",
     or_null(cost<&C::light_moves, &Sides::rays, &T::median>()), less},
    {"times_ms.shadows.light_moves_rays_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::light_moves, &Sides::rays, &T::low>()), less},
    {"times_ms.shadows.light_moves_rays_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::light_moves, &Sides::rays, &T::high>()), less},
    {"times_ms.shadows.casters_move_map", "ms",
     "milliseconds where casters have moved: drawing the map, and looking it up; of the hybrid, its tree "
     "built anew, too; null when not timed",
     or_null(cost<&C::casters_move, &Sides::map, &T::median>()), less},
    {"times_ms.shadows.casters_move_map_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::casters_move, &Sides::map, &T::low>()), less},
    {"times_ms.shadows.casters_move_map_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::casters_move, &Sides::map, &T::high>()), less},
    {"times_ms.shadows.casters_move_rays", "ms",
     "milliseconds where casters have moved: the tree built anew, and the rays; null when not timed",
     or_null(cost<&C::casters_move, &Sides::rays, &T::median>()), less},
    {"times_ms.shadows.casters_move_rays_low", "ms", "milliseconds: the lower end of its interval",
     or_null(cost<&C::casters_move, &Sides::rays, &T::low>()), less},
    {"times_ms.shadows.casters_move_rays_high", "ms", "milliseconds: the upper end of its interval",
     or_null(cost<&C::casters_move, &Sides::rays, &T::high>()), less},
};

/// No key of its own.
constexpr Figure both{
    .key = "",
    .unit = "share",
    .describes = "",
    .place = {larger_of_both, nullptr, FigureForm::percent},
    .measure = {"wrong and mean", "", "at most {} wrong, and a mean error of at most as much",
                "an error of {}", "1%", "", true}};

}  // namespace figure_rows

std::span<const Figure> figures() {
  return figure_rows::rows;
}

const Figure& wrong_and_mean() {
  return figure_rows::both;
}

}  // namespace gnomon::compare
