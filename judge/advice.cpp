#include "judge/advice.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/advice/rule.h"
#include "compare/result/engine_units.h"
#include "compare/result/engines.h"
#include "compare/result/number_text.h"
#include "judge/advisor.h"

namespace gnomon::judge {
namespace {

using compare::Advice;
using compare::AdvisedSetting;

/// World units, ascending: none, half of the present one, one texel and two. The present one is not among them.
std::vector<double> offsets_to_try(double now, double texel_world) {
  std::vector<double> out{0.0, 0.5 * now, texel_world, 2.0 * texel_world};
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  std::erase(out, now);
  return out;
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
  if (bias.constant_world != 0.0 || bias.normal_offset_world != 0.0)  // a shader moves them
    return {"map[].caster_bias.constant_world", bias.constant_world, 1.0, "world units"};
  return {"map[].caster_bias.constant", bias.constant, unit_world, "stored depth"};
}

void unchanged(raster::LightRecord&) {}

}  // namespace

/// The constant alone, and the best normal offset of a few with the constant beside it.
void Advisor::propose_on_receivers() {
  TestedRecord tested = redrawing_.as_drawn();
  const GoodConstant best = search_.best_beside(tested);
  Advice alone;
  static_cast<AdvisedSetting&>(alone) = constant(best.stored);
  propose({alone, unchanged, best.stored});
  double least = best.left;
  if (reads_averages()) return propose_on_own_settings(least);
  std::optional<Candidate> pair;
  for (const double offset : offsets_to_try(test().normal_offset_world, record().texel_world)) {
    const auto change = [offset](raster::LightRecord& one) {
      changed_test(one).normal_offset_world = offset;
    };
    tested.change(change);
    const GoodConstant there = search_.best_beside(tested);
    if (!(there.left < worth_changing * least)) continue;
    least = there.left;
    Advice advice;
    static_cast<AdvisedSetting&>(advice) = {
        "bias.normal_offset_world", test().normal_offset_world, offset, "world units", 1.0,
        record().texel_world};
    advice.with = constant(there.stored);
    pair = Candidate{advice, change, there.stored};
  }
  if (pair) propose(std::move(*pair));
  propose_on_layers(least);
}

/// One setting that the test alone has, and that with the constant that suits it.
void Advisor::propose_on_own_settings(double least) {
  constexpr double like_drawn = 0.1;
  TestedRecord tested = redrawing_.as_drawn();
  const auto left_after = [&](const RecordChange& change) {
    tested.take_tests(redrawing_.as_drawn());
    if (change) tested.change(change);
    return search_.left_at(tested, search_.now);
  };
  std::optional<Candidate> best;
  for (const OtherSettings& group : test().other_settings(in_, record())) {
    if (group.as_is) {
      const double drawn = left_after({});
      if (std::abs(left_after(group.as_is) - drawn) > like_drawn * drawn) continue;
    }
    for (const OtherSetting& other : group.settings) {
      const double left = left_after(other.change);
      if (!(left < worth_changing * least)) continue;
      least = left;
      Advice advice;
      static_cast<AdvisedSetting&>(advice) = other.setting;
      advice.with = other.with;
      best = Candidate{advice, other.change, search_.now, other.about};
    }
  }
  if (!best) return;
  propose(*best);
  if (best->advice.with) return;
  tested.take_tests(redrawing_.as_drawn());
  tested.change(best->change);
  const GoodConstant there = search_.best_beside(tested);
  if (!(there.left < worth_changing * least)) return;
  best->advice.with = constant(there.stored), best->stored = there.stored;
  propose(std::move(*best));
}

void Advisor::propose_on_layers(double least) {
  if (!has_layers(record())) return;
  for (const auto advise : {advise_in_texels, advise_on_layers}) {
    Advice advice = advise(search_);
    std::vector<double> stored{advice.instead};
    for (const AdvisedSetting& layer : advice.layers) stored.push_back(layer.instead);
    const auto change = [stored](raster::LightRecord& one) {
      auto& layers = changed_test(one).layers;
      layers.resize(stored.size());
      for (std::size_t i = 0; i < stored.size(); ++i) layers[i].constant = stored[i] - stored.front();
    };
    TestedRecord tested = redrawing_.as_drawn();
    tested.change(change);
    const double left = search_.left_at(tested, stored.front());
    if (!(left < worth_changing * least)) continue;
    least = left;
    propose({std::move(advice), change, stored.front()});
  }
}

/// In the casters' own terms.
void Advisor::propose_on_casters() {
  const auto moved = std::find_if(casters_.faces.begin(), casters_.faces.end(),
                                  [](const CapturedCasterBias& face) { return face.moves(); });
  const double unit = test().unit_world, now = search_.now;
  const CastersConstant said = casters_constant(*moved, unit);
  const bool in_world = moved->constant_world != 0.0 || moved->normal_offset_world != 0.0;
  const auto change_of = [&, in_world](CapturedCasterBias bias, const AdvisedSetting& constant) {
    (in_world ? bias.constant_world : bias.constant) = constant.instead;
    return [bias, this](raster::LightRecord& one) {
      one.map.depth = with_caster_bias(record().map, casters_, bias);
    };
  };
  const auto change_to = [&](double slope, const AdvisedSetting& constant) {
    CapturedCasterBias bias = *moved;
    bias.slope = slope;
    return change_of(bias, constant);
  };
  TestedRecord tested = redrawing_.as_drawn();
  const GoodConstant best = search_.best_beside(tested);
  const AdvisedSetting alone = said.instead((best.stored - now) * unit, record().texel_world);
  Advice first;
  static_cast<AdvisedSetting&>(first) = alone;
  propose({first, change_to(moved->slope, alone), now});
  double least = best.left;
  std::optional<Candidate> pair;
  if (moved->normal_offset_world != 0.0) {
    CapturedCasterBias upright = *moved;
    upright.normal_offset_world = 0.0;
    tested.change(change_of(upright, {said.setting, said.now, said.now, said.unit}));
    if (const GoodConstant there = search_.best_beside(tested); there.left < worth_changing * least) {
      least = there.left;
      Advice advice;
      static_cast<AdvisedSetting&>(advice) = {"map[].caster_bias.normal_offset_world",
                                              moved->normal_offset_world,
                                              0.0,
                                              "world units",
                                              1.0,
                                              record().texel_world};
      advice.with = said.instead((there.stored - now) * unit, record().texel_world);
      pair = Candidate{advice, change_of(upright, *advice.with), now};
    }
  }
  for (const double slope : slopes_to_try) {
    // A shader that moves casters along their normals has no slope.
    if (slope == moved->slope || moved->normal_offset_world != 0.0) continue;
    tested.change(change_to(slope, {said.setting, said.now, said.now, said.unit}));
    const GoodConstant there = search_.best_beside(tested);
    if (!(there.left < worth_changing * least)) continue;
    least = there.left;
    Advice advice;
    static_cast<AdvisedSetting&>(advice) = {"map[].caster_bias.slope", moved->slope, slope,
                                            "multiples of the stored depth's slope"};
    advice.with = said.instead((there.stored - now) * unit, record().texel_world);
    pair = Candidate{advice, change_to(slope, *advice.with), now};
  }
  if (pair) propose(std::move(*pair));
}

namespace {

bool changes_nothing(const Advice& advice) {
  const auto stays = [](const AdvisedSetting& one) { return one.instead == one.now; };
  return stays(advice) && (!advice.with || stays(*advice.with)) &&
         std::all_of(advice.layers.begin(), advice.layers.end(), stays);
}

}  // namespace

/// Draws a candidate again; false where it is not worth a sentence.
bool Advisor::fill(const Candidate& candidate, Advice& advice) const {
  // Figures are good to a fifth, or said as they are where hardly anything can be off; none are said that hang on what is not
  // explained, or on which of the filters that fit the picture alike draws.
  constexpr double off_by = 0.2, of_spread = 0.1, exactly = 5e-4;
  if (changes_nothing(candidate.advice)) return false;
  TestedRecord tested = redrawing_.as_drawn();
  tested.change(candidate.change);
  const Redrawn left = redrawing_.redraw(tested, candidate.stored * test().unit_world);
  advice = candidate.advice;
  advice.wrong_now = light_.error.wrong_fraction, advice.mean_now = light_.error.mean_absolute;
  advice.wrong_instead = left.wrong_fraction, advice.mean_instead = left.mean_absolute;
  advice.feasible = left.wrong_fraction == 0.0,
  advice.about = candidate.about || left.unexplained + left.of_kernel > exactly;
  const double least = std::min(left.wrong_fraction, left.mean_absolute);
  if (left.unexplained > std::max(exactly, least)) return false;
  const auto is_told = [&](double figure, double spread) {
    return spread <= std::max(exactly, of_spread * figure);
  };
  if (!is_told(left.wrong_fraction, left.wrong_spread) || !is_told(left.mean_absolute, left.mean_spread))
    return false;
  const double factor = advice.about ? 1.0 + off_by : 1.0;
  return compare::is_worth_advising(
      {factor * left.wrong_fraction, factor * left.mean_absolute, factor * left.mean_absolute},
      {advice.wrong_now, *advice.mean_now, *advice.mean_now}, light_.pixels.compared);
}

std::vector<Advice> Advisor::drawn_again() {
  std::vector<Advice> out;
  constexpr std::size_t most_drawn = 3;
  // The simplest, and the two that are likely to leave least.
  if (candidates_.size() > most_drawn)
    candidates_.erase(candidates_.begin() + 1, candidates_.end() - (most_drawn - 1));
  for (const Candidate& candidate : candidates_) {
    Advice advice;
    if (!fill(candidate, advice)) continue;
    if (!out.empty() && !(*advice.mean_instead < worth_changing * *out.back().mean_instead)) continue;
    if (out.size() > 1) out.pop_back();
    out.push_back(std::move(advice));
  }
  return out;
}

std::vector<Advice> give_advice(const FrameInput& in, const raster::RasterFrame& drawn,
                                const compare::LightComparison& light, const CasterBiases& casters,
                                double drawn_constant) {
  return Advisor(in, drawn, light, casters, drawn_constant).advise();
}

namespace {

/// What engines know of a captured test with other numbers: `value` of each setting that the advice names.
std::vector<compare::EngineUnit> units_with(const Advice& advice, double AdvisedSetting::*value,
                                            LightType light, const raster::LightRecord& record,
                                            const World& world) {
  raster::Bias bias;
  const double texel = record.texel_world;
  bias.normal_offset_texels = captured_test(record).normal_offset_world / texel;
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
  return compare::engine_units(bias, constant, light, record, world);
}

}  // namespace

std::vector<std::pair<std::string, double>> settings_in_engine(std::string_view engine, const Advice& advice,
                                                               LightType light, raster::Technique technique,
                                                               const raster::LightRecord& record,
                                                               const World& world) {
  std::vector<std::pair<std::string, double>> out;
  const compare::TunedEngine* known = compare::engine_of_renderer(engine);
  if (known == nullptr || advice.setting.starts_with("filter.")) return out;
  const bool in_texels = advice.texels_of_each && known->constant_in_texels;
  if (!advice.layers.empty() && !in_texels) return out;
  const auto now = units_with(advice, &AdvisedSetting::now, light, record, world);
  const auto instead = units_with(advice, &AdvisedSetting::instead, light, record, world);
  const bool filters = technique == raster::Technique::pcf || technique == raster::Technique::pcss;
  const auto of_filter = [&](const compare::EngineUnit& unit) {
    return filters && unit.part == compare::BiasPart::constant;
  };
  for (std::size_t i = 0; i < std::min(now.size(), instead.size()); ++i)
    if (instead[i].engine == engine && instead[i].value && instead[i].value != now[i].value)
      out.emplace_back(instead[i].setting,
                       *instead[i].value * (of_filter(instead[i]) ? known->filtered_constant : 1.0));
  return out;
}

}  // namespace gnomon::judge
