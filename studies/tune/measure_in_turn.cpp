// Who wins: single times of the search are too rough for that. The families near the best are drawn again,
// one after the other and round after round, so that whatever else the machine does falls on all of them
// alike. The least time of each counts: disturbances only add. Who falls behind is not drawn in further
// rounds.
#include <algorithm>

#include "studies/tune/tuner.h"

namespace gnomon::studies {
namespace {

// Of the best price: wider than what single times are off on a busy machine, and what two of them are off.
constexpr double near_the_best = 2.5, still_near = 1.25;

}  // namespace

bool Tuner::better(const FamilyResult& a, const FamilyResult& b) const {
  if (a.is_tried() != b.is_tried()) return a.is_tried();
  if (a.answer.has_value() != b.answer.has_value()) return a.answer.has_value();
  const Attempt &x = a.attempt(), &y = b.attempt();
  const bool answered = a.answer.has_value();
  const double first_x = answered ? price(x) : shortfall(x), first_y = answered ? price(y) : shortfall(y);
  return first_x != first_y ? first_x < first_y : x.cost < y.cost;
}

std::size_t Tuner::best_of(const TuneResult& result) const {
  return static_cast<std::size_t>(
      std::min_element(result.families.begin(), result.families.end(),
                       [this](const auto& a, const auto& b) { return better(a, b); }) -
      result.families.begin());
}

// What was cheap enough in the search need not be now, and the other way round: the figures that are printed decide.
void Tuner::settle(FamilyResult& result) const {
  const Attempt measured = result.attempt();
  result.answer.reset();
  (good(measured) ? result.answer.emplace() : result.closest) = measured;
}

// At its own bias: what is promised from the gaps is what is drawn.
Expected<void> Tuner::confirm(FamilyResult& result) {
  Attempt& answer = result.attempt();
  auto drawn = draw(result.family, answer.size, answer.bias, nullptr);
  if (!drawn) return fail(drawn.error());
  answer.error = drawn->error;
  answer.figures = drawn->figures;
  answer.lights = drawn->lights;
  answer.times.runs = {drawn->time_ms};
  if (options_.cost) answer.cost = drawn->cost;
  return {};
}

Expected<void> Tuner::draw_again(FamilyResult& result) {
  Attempt& answer = result.attempt();
  const auto ms = engine_.time_drawing(setting_of(result.family, answer.size, answer.bias));
  if (!ms) return fail(ms.error());
  answer.times.runs.push_back(*ms);
  return {};
}

Expected<void> Tuner::measure_in_turn(const std::vector<FamilyResult*>& finalists) {
  for (FamilyResult* finalist : finalists)
    if (auto confirmed = confirm(*finalist); !confirmed) return confirmed;
  for (int round = 1; round < base_.raster.runs; ++round) {
    double least = std::numeric_limits<double>::infinity();
    for (const FamilyResult* finalist : finalists) least = std::min(least, finalist->attempt().times.least());
    for (FamilyResult* finalist : finalists)
      if (finalist->attempt().times.least() <= still_near * least)
        if (auto drawn = draw_again(*finalist); !drawn) return drawn;
  }
  for (FamilyResult* finalist : finalists) {
    Attempt& answer = finalist->attempt();
    answer.time_ms = answer.times.least();
    if (!options_.cost) answer.cost = answer.time_ms;
    settle(*finalist);
  }
  return {};
}

// The best and all that come near it; those measured before once more with the new ones, until nobody near
// the best is left unmeasured.
Expected<void> Tuner::measure_best(TuneResult& result) {
  for (;;) {
    const FamilyResult& best = result.families[best_of(result)];
    std::vector<FamilyResult*> finalists;
    bool all_measured = true;
    for (FamilyResult& family : result.families) {
      const bool near = &family == &best || (best.answer && family.answer &&
                                             price(*family.answer) <= near_the_best * price(*best.answer));
      const bool measured = !family.attempt().times.runs.empty();
      if (near || measured) finalists.push_back(&family);
      all_measured = all_measured && (measured || !near);
    }
    if (all_measured) return {};
    if (auto done = measure_in_turn(finalists); !done) return done;
  }
}

}  // namespace gnomon::studies
