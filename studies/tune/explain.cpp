// Why each family won or lost, in words.
#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_advice.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "studies/tune/tuner.h"

namespace gnomon::studies {
namespace {

using compare::Figure;

std::string setting_text(const TuneFamily& family, const Attempt& a, const Figure& measure) {
  const std::string with =
      family.has_map() ? " with " + compare::with_noun(std::to_string(a.size), "texel") : std::string();
  return fmt::format("{} in {}{}{}", compare::figure_words(a.figures, measure),
                     compare::milliseconds(a.time_ms), with,
                     a.custom_shader ? ", by the shader of --shader-dir" : "");
}

// The sentence of why no constant bias is right everywhere, as a part of a longer one.
std::string proof(const FamilyResult& family, const Attempt& attempt, const Figure& measure) {
  if (!has_proof(attempt, measure)) return {};
  std::string text = compare::contradiction(attempt.best, attempt.texel_world, family.family.map.bias);
  text.front() = static_cast<char>(text.front() - 'A' + 'a'), text.pop_back();
  return "; " + text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string close_race(const FamilyResult& winner, const TuneGoal& goal) {
  if (winner.as_fast.empty()) return {};
  return fmt::format(
      "; {} {} as fast, as far as the times tell{}", joined(winner.as_fast),
      std::string(winner.as_fast.size() == 1 ? "is" : "are") + (goal.max_time_ms ? " as good and" : ""),
      winner.by_cost ? ", and this one costs less on any machine (texels, bytes, rays)" : "");
}

std::string just_over_text(const TuneResult& result, const Figure& measure) {
  std::string text;
  for (const JustOver& over : result.just_over)
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", result.families[over.family].family.name,
                        setting_text(result.families[over.family].family, over.attempt, measure));
  return text.empty()
             ? text
             : "; more accurate, but longer than the limit by no more than one time may be off: " + text;
}

// The answer's own times, where they do not settle that it is cheap enough.
std::string doubtful_time(const Attempt& answer, const TuneGoal& goal) {
  return goal.max_time_ms && answer.times.median() > *goal.max_time_ms
             ? "; half of its own runs took longer than the limit"
             : "";
}

// Pixels of a light that no setting can be judged by.
std::string doubt(const std::optional<compare::Threshold>& goal,
                  const std::vector<compare::LightFigures>& lights) {
  if (!goal) return {};
  const auto light = std::find_if(lights.begin(), lights.end(), [&](const compare::LightFigures& figures) {
    return compare::too_uncertain(*goal, figures);
  });
  if (light == lights.end()) return {};
  return fmt::format(
      "; {} of {} pixels{} are uncertain, more than the goal allows to be wrong (more --samples "
      "of lights with size, or a goal for the mean error, such as mean:1%)",
      compare::grouped(compare::unknown_pixels(*light, *goal->measure)),
      compare::grouped(light->pixels.compared + light->pixels.uncertain),
      lights.size() > 1 ? " of one light" : "");
}

}  // namespace

std::string Tuner::reason(const FamilyResult& loser, const FamilyResult& winner) const {
  const bool by_error = options_.goal.max_error.has_value();
  const Figure& measure = options_.goal.measure();
  if (!loser.answer) {
    const std::string nearest = setting_text(loser.family, loser.closest, measure);
    if (loser.stop == TuneStop::too_dear)
      return "slower before it is good enough: " + nearest + proof(loser, loser.closest, measure);
    if (loser.stop == TuneStop::levels_off)
      return fmt::format(
          "levels off near {}: {}{}",
          fmt::format(fmt::runtime(measure.measure.level), compare::figure_text(measure, loser.floor)),
          nearest, proof(loser, loser.closest, measure));
    if (loser.stop == TuneStop::left)
      return fmt::format("left when {}: {}{}",
                         winner.answer && options_.quick ? "another was good enough" : "the time was over",
                         nearest, proof(loser, loser.closest, measure));
    if (loser.stop == TuneStop::no_smaller)
      return fmt::format("needs at least the map of {}: {}{}", loser.like, nearest,
                         proof(loser, loser.closest, measure));
    return fmt::format("{}{}: {}{}", by_error ? "not good enough" : "too slow",
                       loser.family.has_map() ? " at any size: at best" : "", nearest,
                       proof(loser, loser.closest, measure));
  }
  const Attempt& a = *loser.answer;
  const std::string text = setting_text(loser.family, a, measure);
  if (!winner.answer) return text;
  const bool close =
      std::find(winner.as_fast.begin(), winner.as_fast.end(), loser.family.name) != winner.as_fast.end();
  if (close) return "as fast within the spread of the times: " + text;
  if (by_error)
    return (a.times.runs.empty() ? "slower, measured once: " : "slower, measured in turn with the best: ") +
           text;
  if (price(a) == price(*winner.answer)) return "as good, and slower: " + text;
  return "less accurate: " + text + proof(loser, a, measure);
}

void Tuner::explain(TuneResult& result) const {
  const Figure& measure = options_.goal.measure();
  const FamilyResult& winner = result.families[result.winner];
  for (std::size_t i = 0; i < result.families.size(); ++i) {
    FamilyResult& family = result.families[i];
    if (!family.is_tried())
      family.why = result.feasible && options_.quick ? "not tried: another was good enough"
                                                     : "not tried: the time was over";
    else if (i != result.winner)
      family.why = reason(family, winner);
    else if (result.feasible)
      family.why = (options_.quick            ? "the first that is good enough, others may be cheaper: "
                    : options_.goal.max_error ? "the cheapest that is good enough: "
                                              : "the best that is cheap enough: ") +
                   setting_text(family.family, *family.answer, measure) +
                   doubtful_time(*family.answer, options_.goal) + close_race(family, options_.goal) +
                   just_over_text(result, measure);
    else
      family.why = "comes nearest: " + setting_text(family.family, family.closest, measure) +
                   doubt(options_.goal.max_error, family.closest.lights) +
                   proof(family, family.closest, measure);
  }
}

}  // namespace gnomon::studies
