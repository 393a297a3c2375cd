// Which of the measured families is the answer. Times that lie within each other's spread do not decide: of
// such families one that renders no more texels, takes no more bytes and casts no more rays than the fastest,
// and less of something, is preferred, on any machine. The answer is then held to its word: the comparison
// that its command runs measures its error.
#include <algorithm>

#include "compare/output_parts.h"
#include "compare/tune/tuner.h"

namespace gnomon::compare {
namespace {

// What one run may be off by: the share of its time that measure_in_turn.cpp allows for the same reason.
constexpr double single_run = 1.25;

// Half of the runs lie below this.
double usual_time(const Attempt& a) {
  return a.times.runs.size() > 1 ? a.times.median() : single_run * a.times.least();
}

bool costs_less(const Attempt& a, const Attempt& b) {
  const bool no_more = a.map_texels <= b.map_texels && a.map_bytes <= b.map_bytes && a.rays <= b.rays;
  return no_more && (a.map_texels < b.map_texels || a.map_bytes < b.map_bytes || a.rays < b.rays);
}

}  // namespace

std::size_t Tuner::prefer_by_cost(TuneResult& result, std::size_t fastest) const {
  FamilyResult& first = result.families[fastest];
  if (!options_.goal.max_error || options_.cost || !first.answer || first.answer->times.runs.empty())
    return fastest;
  std::size_t chosen = fastest;
  std::vector<std::size_t> close;
  for (std::size_t i = 0; i < result.families.size(); ++i) {
    const std::optional<Attempt>& other = result.families[i].answer;
    if (i == fastest || !other || other->times.runs.empty()) continue;
    if (other->times.least() > usual_time(*first.answer)) continue;
    close.push_back(i);
    if (costs_less(*other, *result.families[chosen].answer)) chosen = i;
  }
  close.push_back(fastest);
  FamilyResult& winner = result.families[chosen];
  winner.by_cost = chosen != fastest;
  winner.as_fast.clear();
  for (const std::size_t i : close)
    if (i != chosen) winner.as_fast.push_back(result.families[i].family.name);
  return chosen;
}

// What the answer's own command will say.
Expected<void> Tuner::verify(TuneResult& result) {
  FamilyResult& winner = result.families[result.winner];
  Attempt& attempt = winner.answer ? *winner.answer : winner.closest;
  const raster::Bias bias = with_constant(winner.family.map, attempt.bias_world, attempt.texel_world);
  auto setting = options_.as_given ? options_.as_given(result.winner, attempt)
                                   : Expected<Setting>(setting_of(winner.family, attempt.size, bias));
  if (!setting) return fail(setting.error());
  setting->raster.runs = 0;
  if (progress_) progress_(winner.family, attempt.size, renders_);
  ++renders_;
  const auto compared = engine_.compare(*setting);
  if (!compared) return fail(compared.error());
  std::vector<ErrorFigures> lights;
  result.engine_units.clear();
  for (const LightComparison& light : (*compared)->lights) {
    lights.push_back(figures_of(light));
    if (auto units = engine_units(**compared, light); !units.empty())
      result.engine_units.push_back({light_of(**compared, light).name, std::move(units)});
  }
  set_figures(lights, attempt);
  if (winner.answer && !good(*winner.answer)) {
    winner.closest = *winner.answer;
    winner.answer.reset();
  }
  return {};
}

Expected<void> Tuner::choose(TuneResult& result) {
  for (;;) {
    if (auto measured = measure_best(result); !measured) return measured;
    result.winner = prefer_by_cost(result, best_of(result));
    const bool promised = result.families[result.winner].answer.has_value();
    if (auto verified = verify(result); !verified) return verified;
    result.feasible = result.families[result.winner].answer.has_value();
    if (result.feasible || !promised) return {};
  }
}

}  // namespace gnomon::compare
