#include "studies/judge/advice.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "compare/result/engine_units.h"
#include "compare/result/number_text.h"
#include "studies/judge/advice_parts.h"
#include "studies/tune/engines.h"

namespace gnomon::compare {
namespace {

/// World units, ascending: none, half of the present one, one texel and two. The present one is not among them.
std::vector<double> offsets_to_try(double now, double texel_world) {
  std::vector<double> out{0.0, 0.5 * now, texel_world, 2.0 * texel_world};
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  std::erase(out, now);
  return out;
}

TriedConstants try_with_offset(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
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

  AdvisedSetting instead(double by_world, double texel) const {
    return {setting, now, now + by_world / unit_world, unit, unit_world, texel};
  }
};

CastersConstant casters_constant(const CapturedCasterBias& bias, double unit_world) {
  if (bias.constant_world != 0.0)
    return {"map[].caster_bias.constant_world", bias.constant_world, 1.0, "world units"};
  return {"map[].caster_bias.constant", bias.constant, unit_world, "stored depth"};
}

TriedConstants try_with_slope(const FrameInput& in, const raster::Bias& bias, const LightComparison& light,
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
  const TriedConstants tried = try_constants(record, light);
  const double wrong_now = tried.wrong_at(record.bias_constant_world);
  const GoodConstant best = good_constant(tried, unit_world, now);
  const AdvisedSetting set = constant.instead((best.stored - now) * unit_world, record.texel_world);
  std::vector<Advice> out{{set, wrong_now, best.wrong, best.wrong == 0.0}};
  double least = best.wrong;
  for (const double slope : slopes_to_try) {
    if (slope == moved->slope) continue;
    const GoodConstant there =
        good_constant(try_with_slope(in, bias, light, record, casters, slope), unit_world, now);
    if (!(there.wrong < worth_changing * least)) continue;
    least = there.wrong;
    out.resize(1);
    out.push_back({{"map[].caster_bias.slope", moved->slope, slope, "multiples of the stored depth's slope"},
                   wrong_now,
                   there.wrong,
                   there.wrong == 0.0,
                   constant.instead((there.stored - now) * unit_world, record.texel_world)});
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

std::vector<Advice> give_advice(const FrameInput& in, const raster::RasterFrame& drawn,
                                const LightComparison& light, const CasterBiases& casters) {
  const raster::LightRecord& record = drawn.lights.front();
  const raster::Bias& bias = drawn.options.map.bias;
  std::vector<Advice> out;
  const raster::CapturedTest& test = *record.captured->test;
  using Stores = raster::CapturedTest::Stores;
  const std::string unit =
      test.stores == Stores::depths || test.unit_world != 1.0 ? "stored depth" : "world units";
  const TriedConstants tried = try_constants(record, light);
  if (tried.gaps.lit.empty() && tried.gaps.shadowed.empty()) return out;
  if (!casters.faces.empty()) return advise_on_casters(in, bias, light, record, casters);
  const double now = record.bias_constant_world / test.unit_world;
  const double wrong_now = tried.wrong_at(record.bias_constant_world);
  const GoodConstant best = good_constant(tried, test.unit_world, now);
  const auto constant = [&](double instead) {
    return AdvisedSetting{"bias.constant_depth", now, instead, unit, test.unit_world, record.texel_world};
  };
  out.push_back({constant(best.stored), wrong_now, best.wrong, best.wrong == 0.0});
  weigh_mean_error(in, drawn, light, out.front());
  double least = best.wrong;
  for (const double offset : offsets_to_try(test.normal_offset_world, record.texel_world)) {
    const TriedConstants moved = try_with_offset(in, bias, light, record, offset);
    const GoodConstant there = good_constant(moved, test.unit_world, now);
    if (!(there.wrong < worth_changing * least)) continue;
    least = there.wrong;
    out.resize(1);
    out.push_back({{"bias.normal_offset_world", test.normal_offset_world, offset, "world units", 1.0,
                    record.texel_world},
                   wrong_now,
                   there.wrong,
                   there.wrong == 0.0,
                   constant(there.stored)});
  }
  for (const auto advise : {advise_in_texels, advise_on_layers})
    if (auto layers = advise(light, record, wrong_now, least)) {
      least = layers->wrong_instead;
      out.resize(1);
      out.push_back(std::move(*layers));
    }
  return out;
}

namespace {

/// What engines know of a captured test with other numbers: `value` of each setting that the advice names.
std::vector<EngineUnit> units_with(const Advice& advice, double AdvisedSetting::*value, LightType light,
                                   const raster::LightRecord& record, const World& world) {
  raster::Bias bias;
  const double texel = record.texel_world;
  bias.normal_offset_texels = record.captured->test->normal_offset_world / texel;
  double constant = record.bias_constant_world;
  const auto take = [&](const AdvisedSetting& one) {
    if (one.setting.find("normal_offset") != std::string::npos)
      bias.normal_offset_texels = one.*value / texel;
    else if (one.setting.find("slope") != std::string::npos)
      bias.caster_slope = one.*value;
    else
      constant = one.*value * one.unit_world * texel / one.texel_world;  // of layers the same in texels
  };
  take(advice);
  if (advice.with) take(*advice.with);
  return engine_units(bias, constant, light, record, world);
}

}  // namespace

std::vector<std::pair<std::string, double>> settings_in_engine(std::string_view engine, const Advice& advice,
                                                               LightType light,
                                                               const raster::LightRecord& record,
                                                               const World& world) {
  std::vector<std::pair<std::string, double>> out;
  const TunedEngine* known = engine_of_renderer(engine);
  if (known == nullptr) return out;
  const bool in_texels = advice.texels_of_each && known->constant_in_texels;
  if (!advice.layers.empty() && !in_texels) return out;
  const auto now = units_with(advice, &AdvisedSetting::now, light, record, world);
  const auto instead = units_with(advice, &AdvisedSetting::instead, light, record, world);
  for (std::size_t i = 0; i < std::min(now.size(), instead.size()); ++i)
    if (instead[i].engine == engine && instead[i].value && instead[i].value != now[i].value)
      out.emplace_back(instead[i].setting, *instead[i].value);
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
