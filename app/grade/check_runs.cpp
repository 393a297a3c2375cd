#include "app/grade/check_runs.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "app/grade/limited_process.h"
#include "app/shell.h"
#include "scene/one_line.h"

namespace gnomon::app::grade {

namespace {

/// The first line that is no note.
std::string first_error(const std::string& err) {
  std::size_t begin = 0;
  while (begin < err.size()) {
    const std::size_t end = std::min(err.find('\n', begin), err.size());
    const std::string line = err.substr(begin, end - begin);
    if (!line.empty() && !line.starts_with("note: ")) return one_line(line);
    begin = end + 1;
  }
  return {};
}

std::string failure_words(const Outcome& outcome, const Limits& limits) {
  if (outcome.end == Outcome::End::timed_out)
    return fmt::format("drawing did not end within {} s: is there a loop without an end?", limits.seconds);
  if (outcome.end == Outcome::End::killed)
    return fmt::format("the drawing process was ended by signal {}", outcome.code);
  const std::string error = first_error(outcome.err);
  return error.empty() ? fmt::format("the drawing process ended with exit code {}", outcome.code) : error;
}

}  // namespace

CheckRuns::CheckRuns(const Rubric& rubric, std::string shaders, std::string folder)
    : rubric_(&rubric), shaders_(std::move(shaders)), folder_(std::move(folder)) {}

std::string CheckRuns::command(const Run& run) const {
  return fmt::format("gnomon compare {} --technique {}{}", run_text(run), rubric_->technique,
                     shaders_.empty() ? "" : " --shader-dir " + shell_quoted(shaders_));
}

bool CheckRuns::needs_values(const Run& run) const {
  return std::any_of(rubric_->checks.begin(), rubric_->checks.end(), [&](const Check& check) {
    return (check.kind == CheckKind::equals || check.measure.name == "detachment") &&
           std::find(check.runs.begin(), check.runs.end(), run) != check.runs.end();
  });
}

bool CheckRuns::needs_sides(const Run& run) const {
  return std::any_of(rubric_->checks.begin(), rubric_->checks.end(), [&](const Check& check) {
    const bool asks = check.measure.name == "false_shadow" || check.measure.name == "missed_shadow";
    return asks && std::find(check.runs.begin(), check.runs.end(), run) != check.runs.end();
  });
}

Expected<Drawing> CheckRuns::make(const Run& run, const std::string& folder, bool timed, bool values) const {
  std::vector<std::string> words = {"compare", run.scene};
  for (const auto& [name, value] : run.options) {
    words.push_back("--" + name);
    if (!value.empty()) words.push_back(value);
  }
  // No page: a student's own takes figures and pictures.
  words.insert(words.end(),
               {"--technique", rubric_->technique, "--threads", "1", "-o", folder, "--no-report", "--quiet"});
  if (!shaders_.empty()) words.insert(words.end(), {"--shader-dir", shaders_});
  if (!timed) words.insert(words.end(), {"--runs", "1"});
  if (values) words.insert(words.end(), {"--aov", values_folder(folder) + "/values.exr"});
  const auto outcome = run_limited(words, rubric_->limits);
  if (!outcome) return fail(outcome.error());
  Drawing drawing;
  drawing.timed_out = outcome->end == Outcome::End::timed_out;
  drawing.exit_code = outcome->end == Outcome::End::exited ? outcome->code : -1;
  if (drawing.exit_code == static_cast<int>(ErrorKind::cannot_write))  // a full disk is no shader's fault
    return fail(ErrorKind::cannot_write, failure_words(*outcome, rubric_->limits));
  if (drawing.exit_code != 0) {
    drawing.failure = failure_words(*outcome, rubric_->limits);
    return drawing;
  }
  auto result = read_run_result(folder);
  if (!result) return fail(result.error());
  drawing.result = std::move(*result);
  return drawing;
}

Expected<Drawing> CheckRuns::make_with_ties(const Run& run, const std::string& folder) const {
  auto drawing = make(run, folder, false, true);
  if (!drawing || !drawing->result) return drawing;
  if (const auto added = add_ties(*drawing->result); !added) return fail(added.error());
  return drawing;
}

Expected<const Drawing*> CheckRuns::draw(const Run& run) {
  const auto known =
      std::find_if(made_.begin(), made_.end(), [&](const Made& made) { return made.run == run; });
  if (known != made_.end()) return &known->drawing;
  const std::string folder = fmt::format("{}/{}", folder_, made_.size());
  auto drawing = make(run, folder, false, needs_values(run));
  // Few shaders draw anything halfway, so few are drawn twice.
  if (drawing && drawing->result && drawing->result->ties > 0 && needs_sides(run))
    drawing = make_with_ties(run, folder);
  if (!drawing) return fail(drawing.error());
  made_.push_back({run, std::move(*drawing)});
  return &made_.back().drawing;
}

Expected<Drawing> CheckRuns::draw_own_with_bias(const Run& run, double bias) const {
  Run with_bias = run;
  std::erase_if(with_bias.options, [](const auto& option) { return option.first == "bias"; });
  with_bias.options.emplace_back("bias", fmt::format("{}", bias));
  return CheckRuns(*rubric_, "", folder_).make(with_bias, folder_ + "/own", false, false);
}

Expected<Drawing> CheckRuns::draw_timed(const Run& run) {
  return make(run, folder_ + "/timed", true, false);
}

}  // namespace gnomon::app::grade
