// Which of the measured families is the answer. Times that lie within each other's spread do not decide
// (ties.h). The answer is then held to its word: the comparison
// that its command runs measures its error.
#include "compare/result/output_parts.h"
#include "studies/tune/tuner.h"

namespace gnomon::studies {
std::size_t Tuner::prefer_by_cost(TuneResult& result, std::size_t fastest) const {
  const FamilyResult& first = result.families[fastest];
  if (options_.cost || !first.answer || first.answer->times.runs.empty()) return fastest;
  const Ties ties = ties_with(fastest, result.families, options_.goal);
  FamilyResult& winner = result.families[ties.chosen];
  winner.by_cost = ties.chosen != fastest;
  winner.as_fast.clear();
  for (const std::size_t i : ties.others) winner.as_fast.push_back(result.families[i].family.name);
  return ties.chosen;
}

// What the answer's own command will say.
Expected<void> Tuner::verify(TuneResult& result) {
  FamilyResult& winner = result.families[result.winner];
  Attempt& attempt = winner.answer ? *winner.answer : winner.closest;
  auto setting = options_.as_given
                     ? options_.as_given(result.winner, attempt)
                     : Expected<compare::Setting>(setting_of(winner.family, attempt.size, attempt.bias));
  if (!setting) return fail(setting.error());
  setting->raster.runs = 0;
  if (progress_) progress_(winner.family, attempt.size, renders_);
  ++renders_;
  const auto compared = engine_.compare(*setting);
  if (!compared) return fail(compared.error());
  std::vector<compare::LightFigures> lights;
  result.engine_units.clear();
  result.views = (*compared)->views;
  for (const compare::LightComparison& light : (*compared)->lights) {
    lights.push_back(light);
    if (auto units = compare::engine_units(**compared, light); !units.empty())
      result.engine_units.push_back({compare::light_of(**compared, light).name, std::move(units),
                                     compare::derived_for_engines(**compared, light)});
  }
  set_figures(lights, options_.goal.measure(), attempt);
  settle(winner);
  return {};
}

Expected<void> Tuner::choose(TuneResult& result) {
  for (;;) {
    if (auto measured = measure_best(result); !measured) return measured;
    result.winner = prefer_by_cost(result, best_of(result));
    const bool promised = result.families[result.winner].answer.has_value();
    if (auto verified = verify(result); !verified) return verified;
    result.feasible = result.families[result.winner].answer.has_value();
    if (result.feasible && !options_.cost)
      result.just_over = just_over_limit(result.winner, result.families, options_.goal);
    if (result.feasible || !promised) return {};
  }
}

}  // namespace gnomon::studies
