#include "compare/judge/advice.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "compare/bias_curve.h"
#include "compare/biased_test.h"

namespace gnomon::compare {
namespace {

/// Multiples of a texel that are tried as a normal offset.
constexpr std::array tried_offsets{1.0, 2.0};
/// An offset is worth changing for when it leaves less than this share of what the constant leaves.
constexpr double worth = 0.9;

double wrong_share(const GapLists& gaps, double bias) {
  const BiasCurvePoint at = gaps.at(bias);
  const auto count = static_cast<double>(gaps.lit.size() + gaps.shadowed.size());
  return count > 0.0 ? static_cast<double>(at.false_shadow + at.missed_shadow) / count : 0.0;
}

GapLists gaps_with_offset(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                          const raster::LightRecord& drawn, double offset) {
  raster::LightRecord record = drawn;
  record.captured->normal_offset_world = offset;
  fill_record(in, bias, record);
  return sort_gaps(record, light.rungs[0], light.labels);
}

}  // namespace

std::vector<Advice> give_advice(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                                const raster::LightRecord& record) {
  std::vector<Advice> out;
  const raster::CapturedTest& test = *record.captured;
  const bool distances = test.distances;
  const std::string unit = distances ? "world units" : "stored depth";
  const GapLists gaps = sort_gaps(record, light.rungs[0], light.labels);
  if (gaps.lit.empty() && gaps.shadowed.empty()) return out;
  const double now = record.bias_constant_world / test.unit_world;
  const double wrong_now = wrong_share(gaps, record.bias_constant_world);
  const BestBias& best = light.best_bias;
  out.push_back({"bias.constant_depth", now, best.constant_world / test.unit_world, unit, wrong_now,
                 best.wrong_fraction, best.feasible});
  double least = best.wrong_fraction;
  for (const double texels : tried_offsets) {
    const double offset = texels * record.texel_world;
    if (offset <= test.normal_offset_world) continue;
    const GapLists moved = gaps_with_offset(in, bias, light, record, offset);
    const BestBias there = find_best_bias(moved);
    if (!(there.wrong_fraction < worth * least)) continue;
    least = there.wrong_fraction;
    out.resize(1);
    out.push_back({"bias.normal_offset_world", test.normal_offset_world, offset, "world units", wrong_now,
                   there.wrong_fraction, there.feasible});
    out.push_back({"bias.constant_depth, with that offset", now, there.constant_world / test.unit_world, unit,
                   wrong_now, there.wrong_fraction, there.feasible});
  }
  return out;
}

std::string advice_text(const Advice& a) {
  return fmt::format("{} {:.4g} instead of {:.4g} ({}): {:.3g} % of the pixels wrong, with this one {:.3g} %",
                     a.setting, a.instead, a.now, a.unit, 100.0 * a.wrong_instead, 100.0 * a.wrong_now);
}

}  // namespace gnomon::compare
