#include "compare/bias/bias_curve.h"

#include <fmt/core.h>

#include <set>
#include <string>

#include "compare/ladder/budget.h"
#include "compare/metrics/pixel_list.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

// Values greater than b in an ascending list.
std::uint64_t count_above(const std::vector<float>& sorted, float b) {
  return static_cast<std::uint64_t>(sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), b));
}

// Values less than b.
std::uint64_t count_below(const std::vector<float>& sorted, float b) {
  return static_cast<std::uint64_t>(std::lower_bound(sorted.begin(), sorted.end(), b) - sorted.begin());
}

// The interval of a feasible bias, or the two sets of pixels that contradict each other.
void find_proof(const GapLists& gaps, BestBias& best) {
  best.needs_more_than = gaps.lit.empty() ? -infinity : gaps.lit.back();
  best.needs_less_than = gaps.shadowed.empty() ? infinity : gaps.shadowed.front();
  if (best.feasible) return;
  const auto b = static_cast<float>(best.constant_world);
  const auto lit = std::upper_bound(gaps.lit.begin(), gaps.lit.end(), b);
  const auto shadowed = std::upper_bound(gaps.shadowed.begin(), gaps.shadowed.end(), b);
  if (lit != gaps.lit.end()) best.needs_more_than = *lit;
  if (shadowed != gaps.shadowed.begin()) best.needs_less_than = *std::prev(shadowed);
  const auto least_lit = static_cast<float>(best.needs_more_than);
  const auto most_shadowed = static_cast<float>(best.needs_less_than);
  best.lit_pixels_above = gaps.lit.size() - count_below(gaps.lit, least_lit);
  best.shadowed_pixels_below = gaps.shadowed.size() - count_above(gaps.shadowed, most_shadowed);
}

}  // namespace

BiasCurvePoint GapLists::at(double bias) const {
  const auto b = static_cast<float>(bias);
  const std::uint64_t too_dark = count_above(lit, b) + count_above(lit_by_lifting, b),
                      too_light = shadowed.size() - count_above(shadowed, b);
  return {bias, too_dark, too_light, wrong_fraction(too_dark + too_light)};
}

double GapLists::wrong_fraction(std::uint64_t wrong) const {
  return wrong_share(wrong, ties, count());
}

std::uint64_t count_ties(const Image<float>& truth, const Image<Label>& labels) {
  std::uint64_t ties = 0;
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    ties += truth.data[i] == 0.5f && is_compared(labels.data[i]) ? 1 : 0;
  return ties;
}

std::vector<float> gaps_where(const raster::LightRecord& record, const Image<float>& truth,
                              const Image<Label>& labels, bool lit) {
  const std::vector<std::uint32_t> pixels = pixels_where(labels.data.size(), [&](std::size_t i) {
    return is_compared(labels.data[i]) && (lit ? truth.data[i] > 0.5f : truth.data[i] < 0.5f);
  });
  std::vector<float> values(pixels.size());
  parallel_for(values.size(), [&](std::size_t i) { values[i] = record.gap.data[pixels[i]]; });
  return values;
}

GapLists sort_gaps(const raster::LightRecord& record, const Image<float>& truth, const Image<Label>& labels) {
  const auto sorted = [&](bool lit) {
    std::vector<float> values = gaps_where(record, truth, labels, lit);
    sort_numbers(std::span(values));
    return values;
  };
  GapLists gaps;
  gaps.ties = count_ties(truth, labels);
  parallel_invoke([&] { gaps.lit = sorted(true); }, [&] { gaps.shadowed = sorted(false); });
  return gaps;
}

BestBias find_best_bias(const GapLists& gaps) {
  BestBias best;
  // Raising the bias past a lit pixel's gap mends it, past a shadowed pixel's breaks it. Only the gaps
  // themselves and 0 are candidates for the start of the best interval.
  auto lit = std::upper_bound(gaps.lit.begin(), gaps.lit.end(), 0.0f);
  auto shadowed = std::upper_bound(gaps.shadowed.begin(), gaps.shadowed.end(), 0.0f);
  float start = 0.0f;
  std::uint64_t least = ~std::uint64_t{0};
  float best_start = 0.0f;
  float best_end = 0.0f;
  while (true) {
    const auto wrong =
        static_cast<std::uint64_t>((gaps.lit.end() - lit) + (shadowed - gaps.shadowed.begin()));
    const float next_lit = lit == gaps.lit.end() ? std::numeric_limits<float>::infinity() : *lit;
    const float next_shadowed =
        shadowed == gaps.shadowed.end() ? std::numeric_limits<float>::infinity() : *shadowed;
    const float next = std::min(next_lit, next_shadowed);
    if (wrong < least) least = wrong, best_start = start, best_end = next;
    if (!(next < std::numeric_limits<float>::infinity())) break;
    while (lit != gaps.lit.end() && *lit == next) ++lit;
    while (shadowed != gaps.shadowed.end() && *shadowed == next) ++shadowed;
    start = next;
  }
  const float middle = best_start + 0.5f * (best_end - best_start);
  const float near_start = std::min(1.1f * best_start, middle);
  best.constant_world = near_start < best_end ? near_start : best_start;
  best.wrong_fraction = gaps.wrong_fraction(least + count_above(gaps.lit_by_lifting, best_start));
  best.feasible = least == 0;
  find_proof(gaps, best);
  return best;
}

std::vector<BiasCurvePoint> draw_bias_curve(const GapLists& gaps, double texel_world, double current,
                                            double best, int points) {
  const double top = std::max({4.0 * texel_world, 1.25 * current, 1.25 * best});
  std::set<double> biases{current, best};
  for (int i = 0; i < points; ++i) biases.insert(top * i / std::max(1, points - 1));
  std::vector<BiasCurvePoint> curve;
  for (const double bias : biases) curve.push_back(gaps.at(bias));
  return curve;
}

bool biases_follow_from_gaps(const raster::MapOptions& map) {
  return raster::traits_of(map.technique).test == raster::ShadowTest::single && !raster::mixes_cascades(map);
}

bool biases_follow_from_gaps(const raster::RasterFrame& drawn) {
  return !drawn.custom_shader && drawn.has_known_map() && biases_follow_from_gaps(drawn.options.map);
}

raster::Bias with_constant(const raster::MapOptions& map, double constant_world, double texel_world) {
  raster::Bias bias = map.bias;
  const bool scales = raster::scales_bias(map);
  bias.constant = scales ? constant_world / texel_world : constant_world;
  bias.unit = scales ? raster::BiasUnit::texel : raster::BiasUnit::world;
  return bias;
}

double rounded_to_three(double number) {
  return std::stod(fmt::format("{:.3g}", number));
}

raster::Bias with_three_digits(raster::Bias bias) {
  bias.constant = rounded_to_three(bias.constant);
  return bias;
}

void rebias(const Image<std::uint32_t>& primitive, double constant_world, raster::LightRecord& record) {
  record.bias_constant_world = constant_world;
  const auto bias = static_cast<float>(constant_world);
  parallel_for(record.gap.data.size(), [&](std::size_t i) {
    const bool shadowed = primitive.data[i] != no_id && record.gap.data[i] > bias;
    record.visibility.data[i] = shadowed ? 0.0f : 1.0f;
  });
}

}  // namespace gnomon::compare
