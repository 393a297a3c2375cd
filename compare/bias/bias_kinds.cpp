#include "compare/bias/bias_kinds.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "compare/metrics/pixel_list.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

constexpr double few_pixels = 1e-5, few_wrong = 0.02;
constexpr double clearly_smaller = 0.8;  // of the best constant
constexpr float infinite = std::numeric_limits<float>::infinity();

using Kind = KindOfBias;
constexpr std::array<std::string_view, kind_count> kind_names{
    "constant bias", "slope bias", "receiver plane", "adaptive bias", "normal offset", "casters' slope bias"};

/// Each with a setting of 1 or "on".
raster::Bias bias_of(Kind kind, raster::Bias bias) {
  if (kind == slope) bias.slope = 1.0;
  if (kind == receiver_plane) bias.receiver_plane = true;
  if (kind == adaptive) bias.adaptive = true;
  if (kind == normal_offset) bias.normal_offset_texels = 1.0;
  if (kind == caster_slope) bias.caster_slope = 1.0;
  return bias;
}

/// The compared pixels' gaps with every kind of bias but for its constant, in the order of the pixels.
using KindGaps = std::array<std::vector<float>, kind_count>;

float gap_number(double gap) {
  return std::isnan(gap) ? -infinite : static_cast<float>(gap);
}

/// What a slope of 1 takes off the gap where the texel was drawn with the casters' bias.
double gap_per_caster_slope(const raster::LightRecord& record, const raster::MapOptions& drawn,
                            const BiasedLookup& lookup) {
  const LightView& view = record.map.view;
  const double along_ray =
      view.projection == LightProjection::orthographic ? 1.0 : lookup.at.distance / lookup.at.depth;
  const bool scales =
      raster::follows_camera(drawn.technique) && drawn.bias.caster_unit == raster::BiasUnit::texel;
  const double texels = scales ? texel_world_size(view, lookup.at) / record.texel_world : 1.0;
  const double moved = caster_offset(record, lookup.key) * along_ray;
  return (moved - record.caster_constant_world * texels) / drawn.bias.caster_slope;
}

/// Returns the record with a map that has no bias in it: on another renderer's map, too, Gnomon's own kinds are tried.
std::optional<raster::LightRecord> record_to_try(const raster::LightRecord& record) {
  if (!record.foreign && record.map.unbiased.empty()) return std::nullopt;
  raster::LightRecord own = record;
  own.foreign.reset();
  if (!own.map.unbiased.empty()) own.map.depth = std::move(own.map.unbiased), own.map.unbiased.clear();
  return own;
}

/// All kinds but the normal offset look up the same texel.
KindGaps gaps_of_kinds(const LadderInput& in, const raster::Bias& bias,
                       const std::vector<std::uint32_t>& pixels) {
  const raster::MapOptions& drawn = in.drawn.options.map;
  const std::optional<raster::LightRecord> own = record_to_try(in.record());
  const raster::LightRecord& record = own ? *own : in.record();
  std::array<raster::Bias, kind_count> biases;
  KindGaps gaps;
  for (std::size_t k = 0; k < kind_count; ++k) {
    biases[k] = bias_of(static_cast<Kind>(k), bias);
    gaps[k].resize(pixels.size());
  }
  parallel_for(pixels.size(), [&](std::size_t i) {
    const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixels[i]];
    const Vec3 to_light = light_at(in.light(), receiver.position).to_light;
    gaps[normal_offset][i] =
        gap_number(biased_gap(record, biases[normal_offset], to_light, receiver, pixels[i]));
    const auto lookup = biased_lookup(record, biases[plain], to_light, receiver, pixels[i]);
    const auto depth = lookup ? stored_caster(record, lookup->key) : std::nullopt;
    for (std::size_t k = plain; k < normal_offset; ++k)
      gaps[k][i] =
          depth ? gap_number(gap_before(record, biases[k], receiver.normal, *lookup, *depth)) : -infinite;
    gaps[caster_slope][i] = gaps[plain][i];
    if (depth && is_tried(caster_slope, drawn.bias))
      gaps[caster_slope][i] -= static_cast<float>(gap_per_caster_slope(in.record(), drawn, *lookup));
  });
  return gaps;
}

/// Sets a kind of slope to the slopes from which on a pixel is lit beside a constant: its gap less that, over what a slope of 1
/// takes off.
void make_slopes(Kind kind, KindGaps& gaps, double constant) {
  for (std::size_t i = 0; i < gaps[plain].size(); ++i) {
    const double over = double{gaps[plain][i]} - constant;
    const double taken = double{gaps[plain][i]} - double{gaps[kind][i]};
    if (!(over > 0.0))
      gaps[kind][i] = -infinite;
    else
      gaps[kind][i] = taken > 0.0 ? static_cast<float>(over / taken) : infinite;
  }
}

BiasKind of_constant(std::string_view name, const raster::MapOptions& map, const raster::LightRecord& record,
                     const GapLists& gaps, double automatic) {
  const BiasRange range = smallest_good_range(gaps);
  BiasKind kind{name, map.bias, 0.0, false, range.from, range.to};
  const bool may_be_automatic = map.bias.unit != raster::BiasUnit::world;
  if (may_be_automatic && automatic >= range.from && automatic < range.to) {
    kind.bias.constant = 1.0;
    kind.bias.unit = raster::BiasUnit::automatic;
    kind.wrong_fraction = gaps.wrong_fraction_at(automatic);
  } else {
    const double unit = raster::scales_bias(map) ? record.texel_world : 1.0;
    kind.bias.constant = short_number_in(range.from / unit, range.to / unit);
    kind.bias.unit = raster::scales_bias(map) ? raster::BiasUnit::texel : raster::BiasUnit::world;
    kind.wrong_fraction = gaps.wrong_fraction_at(kind.bias.constant * unit);
  }
  return kind;
}

BiasKind of_slope(Kind which, const raster::MapOptions& map, const GapLists& slopes, double automatic) {
  const BiasRange range = smallest_good_range(slopes);
  BiasKind kind{kind_names[which], map.bias, 0.0, true, range.from, range.to};
  const bool world = map.bias.unit == raster::BiasUnit::world;
  kind.bias.constant = world ? automatic : 1.0;
  kind.bias.unit = world ? raster::BiasUnit::world : raster::BiasUnit::automatic;
  double& factor = which == slope ? kind.bias.slope : kind.bias.caster_slope;
  factor = range.from <= 1.0f && range.to > 1.0f ? 1.0 : short_number_in(range.from, range.to);
  kind.wrong_fraction = slopes.wrong_fraction_at(factor);
  return kind;
}

/// The options of a kind with the drawing's way to take a constant: maps that follow the camera have two.
raster::MapOptions plain_options(const raster::MapOptions& drawn) {
  raster::MapOptions map = drawn;
  map.bias = {};
  if (raster::follows_camera(drawn.technique) && drawn.bias.unit == raster::BiasUnit::world)
    map.bias.unit = raster::BiasUnit::world;
  return map;
}

BiasRange good_range_of(const GapLists& gaps, const BestBias& best) {
  const auto count = static_cast<double>(gaps.count());
  const auto at_best = static_cast<float>(best.constant_world);
  const auto lit_above = gaps.lit.end() - std::upper_bound(gaps.lit.begin(), gaps.lit.end(), at_best);
  const auto shadowed_to =
      std::upper_bound(gaps.shadowed.begin(), gaps.shadowed.end(), at_best) - gaps.shadowed.begin();
  const auto least = static_cast<double>(lit_above + shadowed_to);
  const auto allowed = static_cast<std::uint64_t>(least + std::max(few_pixels * count, few_wrong * least));
  auto lit = std::upper_bound(gaps.lit.begin(), gaps.lit.end(), 0.0f);
  auto shadowed = std::upper_bound(gaps.shadowed.begin(), gaps.shadowed.end(), 0.0f);
  BiasRange range{0.0f, infinite};
  bool inside = false;
  for (float start = 0.0f;;) {
    const auto wrong =
        static_cast<std::uint64_t>((gaps.lit.end() - lit) + (shadowed - gaps.shadowed.begin()));
    if (wrong <= allowed && !inside) range.from = start, inside = true;
    if (wrong > allowed && inside) {
      range.to = start;
      break;
    }
    const float next = std::min(lit == gaps.lit.end() ? infinite : *lit,
                                shadowed == gaps.shadowed.end() ? infinite : *shadowed);
    if (!(next < infinite)) break;
    while (lit != gaps.lit.end() && *lit == next) ++lit;
    while (shadowed != gaps.shadowed.end() && *shadowed == next) ++shadowed;
    start = next;
  }
  return range;
}

}  // namespace

BiasRange smallest_good_range(const GapLists& gaps) {
  return good_range_of(gaps, find_best_bias(gaps));
}

BestBias find_advised_bias(const GapLists& gaps, double unit_world) {
  BestBias best = find_best_bias(gaps);
  const auto setting = [&](double number) {
    return BestBias::Setting{number * unit_world, gaps.wrong_fraction_at(number * unit_world)};
  };
  best.rounded = setting(rounded_to_three(best.constant_world / unit_world));
  if (best.feasible) return best;  // then the best is a tenth above the least that is right
  const BiasRange range = good_range_of(gaps, best);
  const BestBias::Setting smaller = setting(short_number_in(range.from / unit_world, range.to / unit_world));
  if (smaller.constant_world < clearly_smaller * best.constant_world) best.smaller = smaller;
  return best;
}

double short_number_in(double from, double to) {
  if (from <= 0.0) return 0.0;
  for (int digits = 1; digits <= 3; ++digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(from)) - (digits - 1));
    const double up = std::stod(fmt::format("{:.{}e}", std::ceil(from / unit) * unit, digits - 1));
    if (up >= from && up < to && up <= 1.25 * from) return up;
  }
  return rounded_to_three(from);
}

bool kinds_apply(const raster::RasterFrame& drawn, const raster::LightRecord& record) {
  return biases_follow_from_gaps(plain_options(drawn.options.map)) && !record.map.depth.empty();
}

KindSettings settings_of_kinds(const LadderInput& in, const std::array<Image<float>, rung_count>& rungs,
                               const Image<Label>& labels) {
  const Image<float>&truth = rungs[0], &at_texel = rungs[static_cast<std::size_t>(Rung::texel)];
  const raster::MapOptions map = plain_options(in.drawn.options.map);
  const std::vector<std::uint32_t> pixels = pixels_where(labels.data.size(), [&](std::size_t i) {
    return is_compared(labels.data[i]) && truth.data[i] != 0.5f;
  });
  KindSettings out{gaps_of_kinds(in, map.bias, pixels), std::vector<PixelSide>(pixels.size()),
                   count_ties(truth, labels)};
  const double constant =
      raster::automatic_bias_world(in.record().rounding, in.record().map.view, in.world());
  for (const Kind kind : {slope, caster_slope}) make_slopes(kind, out.settings, constant);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (truth.data[pixels[i]] < 0.5f)
      out.sides[i] = PixelSide::shadowed;
    else
      out.sides[i] = at_texel.data[pixels[i]] < 0.5f ? PixelSide::lit_by_lifting : PixelSide::lit;
  }
  return out;
}

void append_to_lists(const std::vector<float>& settings, const std::vector<PixelSide>& sides,
                     GapLists& lists) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (sides[i] == PixelSide::shadowed)
      lists.shadowed.push_back(settings[i]);
    else if (!(settings[i] > 0.0f))
      ++lists.lit_left_out;
    else
      (sides[i] == PixelSide::lit ? lists.lit : lists.lit_by_lifting).push_back(settings[i]);
  }
}

bool is_tried(KindOfBias kind, const raster::Bias& drawn) {
  return kind != caster_slope || drawn.caster_slope != 0.0;
}

namespace {

/// A constant takes the same off every gap whether receivers have it or casters.
raster::Bias as_casters(raster::Bias bias, double automatic) {
  const bool number = bias.unit != raster::BiasUnit::automatic;
  bias.caster_constant = number ? bias.constant : automatic;
  bias.caster_unit = number ? bias.unit : raster::BiasUnit::world;
  bias.constant = 0.0, bias.unit = raster::BiasUnit::world;
  return bias;
}

}  // namespace

BiasKind kind_of_bias(KindOfBias kind, const LadderInput& in, const GapLists& lists) {
  const raster::MapOptions map = plain_options(in.drawn.options.map);
  const double automatic =
      raster::automatic_bias_world(in.record().rounding, in.record().map.view, in.world());
  if (kind == slope || kind == caster_slope) return of_slope(kind, map, lists, automatic);
  raster::MapOptions tried = map;
  tried.bias = bias_of(kind, map.bias);
  BiasKind found = of_constant(kind_names[kind], tried, in.record(), lists, automatic);
  const raster::Bias& drawn = in.drawn.options.map.bias;
  if (kind == plain && drawn.caster_constant != 0.0) found.bias = as_casters(found.bias, automatic);
  return found;
}

void sort_kinds(std::vector<BiasKind>& kinds) {
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const BiasKind& a, const BiasKind& b) { return a.wrong_fraction < b.wrong_fraction; });
}

}  // namespace gnomon::compare
