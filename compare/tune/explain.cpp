// Why each family won or lost, in words.
#include <fmt/format.h>

#include "compare/number_text.h"
#include "compare/tune/tuner.h"

namespace gnomon::compare {
namespace {

std::string setting_text(const Attempt& a) {
  return fmt::format("{} wrong in {} with {} texels", percent(a.error), milliseconds(a.time_ms), a.size);
}

std::string proof(const BestBias& best) {
  if (best.feasible || best.lit_pixels_above == 0) return {};
  return fmt::format(
      "; no constant bias is right everywhere: {} lit pixels need {} or more, {} shadowed ones less "
      "than {}",
      grouped(best.lit_pixels_above), plain_number(best.needs_more_than), grouped(best.shadowed_pixels_below),
      plain_number(best.needs_less_than));
}

}  // namespace

std::string Tuner::reason(const FamilyResult& loser, const FamilyResult& winner) const {
  const bool by_error = options_.goal.max_error.has_value();
  if (!loser.answer) {
    const std::string nearest = setting_text(loser.closest);
    if (loser.stop == TuneStop::too_dear)
      return "slower before it is good enough: " + nearest + proof(loser.closest.best);
    if (loser.stop == TuneStop::levels_off)
      return fmt::format("levels off near {} wrong: {}{}", percent(loser.floor), nearest,
                         proof(loser.closest.best));
    if (loser.stop == TuneStop::no_smaller)
      return fmt::format("needs a map no smaller than {}: {}{}", loser.like, nearest,
                         proof(loser.closest.best));
    return (by_error ? "not good enough at any size: at best " : "too slow at any size: at best ") + nearest +
           proof(loser.closest.best);
  }
  const Attempt& a = *loser.answer;
  if (!winner.answer) return setting_text(a);
  if (by_error)
    return (a.times.runs.empty() ? "slower, measured once: " : "slower, measured in turn with the best: ") +
           setting_text(a);
  if (price(a) == price(*winner.answer)) return "as good, and slower: " + setting_text(a);
  return "less accurate: " + setting_text(a) + proof(a.best);
}

void Tuner::explain(TuneResult& result) const {
  const FamilyResult& winner = result.families[result.winner];
  for (std::size_t i = 0; i < result.families.size(); ++i) {
    FamilyResult& family = result.families[i];
    if (i != result.winner)
      family.why = reason(family, winner);
    else if (result.feasible)
      family.why = (options_.goal.max_error ? "the cheapest that is good enough: "
                                            : "the best that is cheap enough: ") +
                   setting_text(*family.answer);
    else
      family.why = "comes nearest: " + setting_text(family.closest) + proof(family.closest.best);
  }
}

}  // namespace gnomon::compare
