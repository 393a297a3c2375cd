#include "studies/judge/advice.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_kinds.h"
#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "compare/result/number_text.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

/// Another setting is worth changing for when it leaves less than this share of what the simpler one leaves.
constexpr double worth = 0.9;
/// Hardly worse than the best: by one compared pixel in 100,000, or by one wrong pixel in fifty.
constexpr double few_pixels = 1e-5, few_wrong = 0.02;

/// What the test draws with every constant: of pixels inside the map by their gaps; those outside stay as they are.
struct Tried {
  GapLists gaps;
  std::uint64_t outside = 0, outside_wrong = 0, outside_ties = 0;

  double pixels() const { return static_cast<double>(gaps.count() + outside); }
  double wrong(std::uint64_t inside) const {
    return (double(inside + outside_wrong) + 0.5 * double(gaps.ties + outside_ties)) /
           std::max(1.0, pixels());
  }
  std::uint64_t inside_at(double bias) const {
    const BiasCurvePoint point = gaps.at(bias);
    return point.false_shadow + point.missed_shadow;
  }
  double wrong_at(double bias) const { return wrong(inside_at(bias)); }
};

/// A constant below 0 that is hardly wrong more often than the best of those, the one nearest to 0.
std::optional<BiasRange> good_range_below_zero(const GapLists& gaps) {
  std::vector<float> starts;  // ascending: between two of them nothing changes
  for (const std::vector<float>* list : {&gaps.lit, &gaps.shadowed})
    for (const float gap : *list)
      if (gap < 0.0f && std::isfinite(gap)) starts.push_back(gap);
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  std::vector<std::uint64_t> wrong(starts.size());
  parallel_for(starts.size(), [&](std::size_t i) {
    const BiasCurvePoint point = gaps.at(double{starts[i]});
    wrong[i] = point.false_shadow + point.missed_shadow;
  });
  if (starts.empty()) return std::nullopt;
  const auto least = static_cast<double>(*std::min_element(wrong.begin(), wrong.end()));
  const double allowed = least + std::max(few_pixels * double(gaps.count()), few_wrong * least);
  std::size_t last = starts.size() - 1;
  while (double(wrong[last]) > allowed) --last;
  std::size_t first = last;
  while (first > 0 && double(wrong[first - 1]) <= allowed) --first;
  return BiasRange{starts[first], last + 1 < starts.size() ? starts[last + 1] : 0.0f};
}

/// A constant that is hardly wrong more often than the best one: the present one if it is, else the one nearest to 0.
struct Constant {
  double stored = 0.0;  ///< in the map's own numbers
  double wrong = 0.0;   ///< share of the compared pixels
};

Constant good_constant(const Tried& tried, double unit_world, double now) {
  const BiasRange range = smallest_good_range(tried.gaps);
  const auto at = [&](double stored) { return Constant{stored, tried.wrong_at(stored * unit_world)}; };
  Constant best = at(short_number_in(range.from / unit_world, range.to / unit_world));
  if (const auto below = good_range_below_zero(tried.gaps)) {
    const double most = -double{below->from} / unit_world;
    const double least = std::max(std::nextafter(-double{below->to} / unit_world, infinity), 1e-3 * most);
    const Constant negative = at(-short_number_in(least, most));
    if (negative.wrong < worth * best.wrong) best = negative;
  }
  const Constant present = at(now);
  const double hardly = std::max(few_pixels, few_wrong * best.wrong);
  return present.wrong <= best.wrong + hardly ? present : best;
}

/// World units, ascending: none, half of the present one, one texel and two. The present one is not among them.
std::vector<double> offsets_to_try(double now, double texel_world) {
  std::vector<double> out{0.0, 0.5 * now, texel_world, 2.0 * texel_world};
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  std::erase(out, now);
  return out;
}

Tried try_constants(const raster::LightRecord& record, const LightComparison& light) {
  Tried out;
  Image<Label> inside = light.labels;
  for (std::size_t i = 0; i < inside.data.size(); ++i) {
    if (!is_compared(inside.data[i]) || record.outside_map.data[i] == 0) continue;
    inside.data[i] = Label::background;
    const float off = std::abs(light.rungs[6].data[i] - light.rungs[0].data[i]);
    ++out.outside, out.outside_wrong += off > 0.5f ? 1 : 0, out.outside_ties += off == 0.5f ? 1 : 0;
  }
  out.gaps = sort_gaps(record, light.rungs[0], inside);
  return out;
}

Tried try_with_offset(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                      const raster::LightRecord& drawn, double offset) {
  raster::LightRecord record = drawn;
  record.captured->test->normal_offset_world = offset;
  fill_record(in, bias, record);
  return try_constants(record, light);
}

/// Factors of polygon offset that people set.
constexpr double slopes_to_try[] = {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0};

/// Which of the casters' settings a constant is said by. What the test adds itself stays as it is: one less of the casters'
/// constant is one more of the receivers'.
struct CastersConstant {
  const char* setting;
  double now, unit_world;  ///< world units in one of the setting
  const char* unit;

  AdvisedSetting instead(double by_world) const { return {setting, now, now + by_world / unit_world, unit}; }
};

CastersConstant casters_constant(const CapturedCasterBias& bias, double unit_world) {
  if (bias.constant_world != 0.0)
    return {"map[].caster_bias.constant_world", bias.constant_world, 1.0, "world units"};
  return {"map[].caster_bias.constant", bias.constant, unit_world, "stored depth"};
}

Tried try_with_slope(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                     const raster::LightRecord& drawn, const CasterBiases& casters, double slope) {
  raster::LightRecord record = drawn;
  record.map.depth = with_caster_slope(drawn.map, casters, slope);
  fill_record(in, bias, record);
  return try_constants(record, light);
}

/// In the casters' own terms.
std::vector<Advice> advise_on_casters(const FrameInput& in, const raster::Bias& bias,
                                      const LightComparison& light, const raster::LightRecord& record,
                                      const CasterBiases& casters) {
  const double unit_world = record.captured->test->unit_world, now = record.bias_constant_world / unit_world;
  const auto moved = std::find_if(casters.faces.begin(), casters.faces.end(),
                                  [](const CapturedCasterBias& face) { return face.moves(); });
  const CastersConstant constant = casters_constant(*moved, unit_world);
  const Tried tried = try_constants(record, light);
  const double wrong_now = tried.wrong_at(record.bias_constant_world);
  const Constant best = good_constant(tried, unit_world, now);
  const AdvisedSetting set = constant.instead((best.stored - now) * unit_world);
  std::vector<Advice> out{
      {set.setting, set.now, set.instead, set.unit, wrong_now, best.wrong, best.wrong == 0.0}};
  double least = best.wrong;
  for (const double slope : slopes_to_try) {
    if (slope == moved->slope) continue;
    const Constant there =
        good_constant(try_with_slope(in, bias, light, record, casters, slope), unit_world, now);
    if (!(there.wrong < worth * least)) continue;
    least = there.wrong;
    out.resize(1);
    out.push_back({"map[].caster_bias.slope", moved->slope, slope, "multiples of the stored depth's slope",
                   wrong_now, there.wrong, there.wrong == 0.0,
                   constant.instead((there.stored - now) * unit_world)});
  }
  return out;
}

/// How far receivers reach that the picture shows, across a parallel map's window.
std::string window_words(const FrameInput& in, const LightComparison& light, const LightView& view) {
  const LightFace& face = view.face(0);
  Vec2 reach(0.0);
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!is_compared(light.labels.data[i])) continue;
    const Vec3 place = in.traced.receiver.data[i].position - view.origin;
    const Vec2 at(glm::dot(place, face.right), glm::dot(place, face.up));
    reach = glm::max(reach, glm::abs(at - face.center));
  }
  return fmt::format(
      "a window of {:.3g} x {:.3g} world units about the same middle (now {:.3g} x {:.3g}) holds all that "
      "the picture shows",
      2.0 * std::max(reach.x, face.half_extent.x), 2.0 * std::max(reach.y, face.half_extent.y),
      2.0 * face.half_extent.x, 2.0 * face.half_extent.y);
}

}  // namespace

std::vector<Advice> give_advice(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
                                const raster::LightRecord& record, const CasterBiases& casters) {
  std::vector<Advice> out;
  const raster::CapturedTest& test = *record.captured->test;
  using Stores = raster::CapturedTest::Stores;
  const std::string unit =
      test.stores == Stores::depths || test.unit_world != 1.0 ? "stored depth" : "world units";
  const Tried tried = try_constants(record, light);
  if (tried.gaps.lit.empty() && tried.gaps.shadowed.empty()) return out;
  if (!casters.faces.empty()) return advise_on_casters(in, bias, light, record, casters);
  const double now = record.bias_constant_world / test.unit_world;
  const double wrong_now = tried.wrong_at(record.bias_constant_world);
  const Constant best = good_constant(tried, test.unit_world, now);
  out.push_back({"bias.constant_depth", now, best.stored, unit, wrong_now, best.wrong, best.wrong == 0.0});
  double least = best.wrong;
  for (const double offset : offsets_to_try(test.normal_offset_world, record.texel_world)) {
    const Tried moved = try_with_offset(in, bias, light, record, offset);
    const Constant there = good_constant(moved, test.unit_world, now);
    if (!(there.wrong < worth * least)) continue;
    least = there.wrong;
    out.resize(1);
    out.push_back({"bias.normal_offset_world", test.normal_offset_world, offset, "world units", wrong_now,
                   there.wrong, there.wrong == 0.0,
                   AdvisedSetting{"bias.constant_depth", now, there.stored, unit}});
  }
  return out;
}

std::vector<std::string> outside_map_notes(const FrameInput& in, const LightComparison& light,
                                           const raster::LightRecord& record) {
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
  if (2 * outside <= light.error.wrong || outside == 0) return {};
  const LightView& view = record.map.view;
  const bool parallel = view.projection == LightProjection::orthographic && view.face_count == 1;
  return {fmt::format(
      "{} of {} wrong pixels lie outside the map, where no bias changes anything: {}light what lies "
      "outside",
      grouped(outside), grouped(light.error.wrong),
      parallel ? window_words(in, light, view) + ", or " : std::string())};
}

}  // namespace gnomon::compare
