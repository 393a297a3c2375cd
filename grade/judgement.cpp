#include "grade/judgement.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"
#include "grade/answers.h"

namespace gnomon::grade {

namespace {

std::string measured(double value, Measure::Unit unit) {
  return unit == Measure::Unit::share ? compare::percent(value) : compare::texels_text(value);
}

/// The points do not jump at a limit: they are gone where it is missed by as much again.
double share_beyond(double value, double limit) {
  return limit > 0.0 ? std::clamp(2.0 - value / limit, 0.0, 1.0) : 0.0;
}

Judgement judge_figure(const Check& check, const RunResult& result) {
  const double value = figure_of(result, check.measure.name);
  const double unknown = check.measure.may_be_unknown ? figure_of(result, "custom_shader") : 0.0;
  const bool passed = value + unknown <= check.limit;
  const bool is_label = check.measure.words == "an error with this label";
  const std::string words =
      is_label ? fmt::format("{} error", check.measure.name) : std::string(check.measure.words);
  const std::string more =
      unknown > 0.0
          ? fmt::format(", and {} that the shader itself made (custom_shader) and that may be the same,",
                        compare::percent(unknown))
          : "";
  return {passed,
          fmt::format("{}: {}{} ({} {} allowed)", words, measured(value, check.measure.unit), more,
                      passed ? "up to" : "no more than", measured(check.limit, check.measure.unit)),
          share_beyond(value + unknown, check.limit)};
}

/// What a shader of one's own lights wrongly is known by no label: its shadows start where the program's own do with the
/// bias that draws most nearly the same.
Expected<Judgement> judge_detachment(const Check& check, const RunResult& result, const Run& run,
                                     const CheckRuns& runs) {
  if (figure_of(result, "custom_shader") == 0.0) return judge_figure(check, result);
  const auto bias = nearest_bias(result);
  if (!bias) return fail(bias.error());
  const auto nearest = runs.draw_own_with_bias(run, *bias);
  if (!nearest) return fail(nearest.error());
  if (!nearest->result)
    return Judgement{false, fmt::format("{}: not known ({})", check.measure.words, nearest->failure)};
  Judgement judgement = judge_figure(check, *nearest->result);
  judgement.reason += fmt::format("; what is drawn is nearest to a bias of {:.3g}", *bias);
  return judgement;
}

Expected<Judgement> judge_equality(const Check& check, const RunResult& result, const Run& run, Class& of) {
  const std::lock_guard lock(of.own_mutex);
  const auto own = of.own.draw(run);
  if (!own) return fail(own.error());
  const auto different = count_different(result, *(*own)->result);
  if (!different) return fail(different.error());
  const bool passed = static_cast<double>(*different) <= check.limit;
  return Judgement{
      passed,
      fmt::format("{} pixel{} from the program's own drawing ({} {} allowed)", compare::grouped(*different),
                  *different == 1 ? " differs" : "s differ", passed ? "up to" : "no more than", check.limit),
      share_beyond(static_cast<double>(*different), check.limit)};
}

/// `result`: what the other checks judge, drawn by another process.
Expected<Judgement> judge_time(const Check& check, const RunResult& result, const Run& run, CheckRuns& runs,
                               Class& of) {
  const std::unique_lock alone(of.quiet);
  const auto theirs = runs.draw_timed(run);
  if (!theirs) return fail(theirs.error());
  if (!theirs->result) return Judgement{false, theirs->failure};
  const auto different = count_different(result, *theirs->result);
  if (!different) return fail(different.error());
  if (*different > 0)
    return Judgement{false, fmt::format("draws differently when it is timed: {} pixel{}",
                                        compare::grouped(*different), *different == 1 ? "" : "s")};
  const std::lock_guard lock(of.own_mutex);
  const auto own = of.own.draw_timed(run);
  if (!own) return fail(own.error());
  if (!own->result) return fail(ErrorKind::internal, own->failure);
  if (!(own->result->shading_ms > 0.0))
    return fail(ErrorKind::graphics, "the program's own drawing took no time that could be measured");
  const double ratio = theirs->result->shading_ms / own->result->shading_ms;
  const bool passed = ratio <= check.limit;
  return Judgement{passed,
                   fmt::format("{} of shading, {:.2f} times the program's own ({} {} times allowed)",
                               compare::milliseconds(theirs->result->shading_ms), ratio,
                               passed ? "up to" : "no more than", check.limit),
                   share_beyond(ratio, check.limit)};
}

/// No points are left where half of the answers are wrong.
Judgement judge_answers(const Run& run, const RunResult& result) {
  const AnswerCount count = count_answers(run, result);
  if (count.wrong == 0) return {true, fmt::format("all {} answers are right", count.cases)};
  return {false,
          fmt::format("{}; {} of {} answers {} wrong", count.first_wrong, count.wrong, count.cases,
                      count.wrong == 1 ? "is" : "are"),
          std::max(0.0, 1.0 - 2.0 * static_cast<double>(count.wrong) / static_cast<double>(count.cases))};
}

}  // namespace

Expected<const Drawing*> draw_undisturbed(CheckRuns& runs, const Run& run, std::shared_mutex& quiet) {
  auto drawing = [&] {
    const std::shared_lock beside_others(quiet);
    return runs.draw(run);
  }();
  if (!drawing || !(*drawing)->disturbed) return drawing;
  const std::unique_lock alone(quiet);
  return runs.draw(run);
}

Expected<Judgement> judge(const Check& check, const Run& run, const RunResult& result, CheckRuns& runs,
                          Class& of) {
  switch (check.kind) {
    case CheckKind::draws:
      return Judgement{true, "it compiles and draws"};
    case CheckKind::at_most:
      return check.measure.name == "detachment" ? judge_detachment(check, result, run, runs)
                                                : judge_figure(check, result);
    case CheckKind::equals:
      return judge_equality(check, result, run, of);
    case CheckKind::time:
      return judge_time(check, result, run, runs, of);
    case CheckKind::answers:
      return judge_answers(run, result);
  }
  return fail(ErrorKind::internal, "unknown kind of check");
}

}  // namespace gnomon::grade
