#include "studies/judge/advice.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_kinds.h"
#include "compare/ladder/biased_test.h"
#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

/// An offset is worth changing for when it leaves less than this share of what the constant leaves.
constexpr double worth = 0.9;

/// A constant that is hardly wrong more often than the best one: the present one if it is, else the smallest.
struct Constant {
  double stored = 0.0;  ///< in the map's own numbers
  double wrong = 0.0;   ///< share of the compared pixels
};

Constant good_constant(const GapLists& gaps, double unit_world, double now) {
  const BiasRange range = smallest_good_range(gaps);
  const bool stays = now * unit_world >= range.from && now * unit_world < range.to;
  const double stored = stays ? now : short_number_in(range.from / unit_world, range.to / unit_world);
  return {stored, gaps.wrong_fraction_at(stored * unit_world)};
}

/// World units, ascending: none, half of the present one, one texel and two. The present one is not among them.
std::vector<double> offsets_to_try(double now, double texel_world) {
  std::vector<double> out{0.0, 0.5 * now, texel_world, 2.0 * texel_world};
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  std::erase(out, now);
  return out;
}

GapLists gaps_with_offset(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                          const raster::LightRecord& drawn, double offset) {
  raster::LightRecord record = drawn;
  record.captured->test->normal_offset_world = offset;
  fill_record(in, bias, record);
  return sort_gaps(record, light.rungs[0], light.labels);
}

}  // namespace

std::vector<Advice> give_advice(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                                const raster::LightRecord& record) {
  std::vector<Advice> out;
  const raster::CapturedTest& test = *record.captured->test;
  const bool distances = test.distances;
  const std::string unit = distances ? "world units" : "stored depth";
  const GapLists gaps = sort_gaps(record, light.rungs[0], light.labels);
  if (gaps.lit.empty() && gaps.shadowed.empty()) return out;
  const double now = record.bias_constant_world / test.unit_world;
  const double wrong_now = gaps.wrong_fraction_at(record.bias_constant_world);
  const Constant best = good_constant(gaps, test.unit_world, now);
  out.push_back({"bias.constant_depth", now, best.stored, unit, wrong_now, best.wrong, best.wrong == 0.0});
  double least = best.wrong;
  for (const double offset : offsets_to_try(test.normal_offset_world, record.texel_world)) {
    const GapLists moved = gaps_with_offset(in, bias, light, record, offset);
    const Constant there = good_constant(moved, test.unit_world, now);
    if (!(there.wrong < worth * least)) continue;
    least = there.wrong;
    out.resize(1);
    out.push_back({"bias.normal_offset_world", test.normal_offset_world, offset, "world units", wrong_now,
                   there.wrong, there.wrong == 0.0});
    out.push_back({"bias.constant_depth, with that offset", now, there.stored, unit, wrong_now, there.wrong,
                   there.wrong == 0.0});
  }
  return out;
}

}  // namespace gnomon::compare
