#include "grade/check_runs.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>

#include "grade/grade.h"
#include "grade/mistakes.h"
#include "raster/use_shaders.h"
#include "scene/base/expected.h"
#include "scene/base/many_commands.h"
#include "scene/base/option_text.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"

namespace gnomon::grade {

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
  if (outcome.end == Outcome::End::out_of_time)
    return fmt::format("drawing did not end within {} s of processor time: is there a loop without an end?",
                       limits.seconds);
  if (outcome.end == Outcome::End::stalled)
    return fmt::format("the drawing process did nothing for {} s", limits.idle_seconds);
  if (outcome.end == Outcome::End::killed)
    return fmt::format("the drawing process was ended by signal {}", outcome.code);
  const std::string error = first_error(outcome.err);
  return error.empty() ? fmt::format("the drawing process ended with exit code {}", outcome.code) : error;
}

/// Drawn again with nothing beside it, such an end is the shader's doing: it has a mistake, or asked for too much.
bool is_shaders_fault(const Outcome& outcome) {
  return outcome.end == Outcome::End::exited && (outcome.code == static_cast<int>(ErrorKind::graphics) ||
                                                 outcome.code == static_cast<int>(ErrorKind::bad_input));
}

/// Ends that somebody else than the shader may have caused. Such is a file that could not be read, the system, which takes a
/// process's memory for others, or whoever sends signals (whose exit codes these are). A shader that has a mistake ends with
/// ErrorKind::bad_input as well, and one that asks for more than it may have with ErrorKind::graphics.
bool may_be_disturbed(const Outcome& outcome) {
  constexpr std::array signals{SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGQUIT};
  const auto is_from_outside = [&](int signal) {
    return std::find(signals.begin(), signals.end(), signal) != signals.end();
  };
  switch (outcome.end) {
    case Outcome::End::stalled:
      return true;
    case Outcome::End::killed:
      return is_from_outside(outcome.code);
    case Outcome::End::exited:
      return is_shaders_fault(outcome) || outcome.code == static_cast<int>(ErrorKind::internal) ||
             is_from_outside(outcome.code - 128);
    case Outcome::End::out_of_time:
      break;
  }
  return false;
}

}  // namespace

CheckRuns::CheckRuns(const Rubric& rubric, std::string shaders, std::string folder)
    : rubric_(&rubric),
      process_(std::in_place, program_beside("gnomon"), std::vector<std::string>{commands_from_stdin},
               rubric.limits),
      shaders_(std::move(shaders)),
      folder_(std::move(folder)) {}

std::string CheckRuns::command(const Run& run) const {
  if (!run.function.empty()) return fmt::format("gnomon shaders {} --shader-dir student", run_text(run));
  return fmt::format("gnomon compare {} --technique {}{}", run_text(run), rubric_->technique,
                     shaders_.empty() ? "" : " --shader-dir student");
}

bool CheckRuns::needs_values(const Run& run) const {
  if (!run.function.empty()) return false;
  if (has_known_mistakes(*rubric_)) return true;
  return std::any_of(rubric_->checks.begin(), rubric_->checks.end(), [&](const Check& check) {
    const bool asks = check.kind == CheckKind::equals || check.kind == CheckKind::time ||
                      check.measure.name == "detachment";
    return asks && std::find(check.runs.begin(), check.runs.end(), run) != check.runs.end();
  });
}

bool CheckRuns::needs_sides(const Run& run) const {
  return std::any_of(rubric_->checks.begin(), rubric_->checks.end(), [&](const Check& check) {
    const bool asks = check.measure.name == "false_shadow" || check.measure.name == "missed_shadow";
    return asks && std::find(check.runs.begin(), check.runs.end(), run) != check.runs.end();
  });
}

std::vector<std::string> CheckRuns::words_of(const Run& run, const std::string& folder) const {
  if (!run.function.empty())
    return {"shaders", "--call", run.function, "--json", answers_file(folder), "--quiet"};
  std::vector<std::string> words = {"compare", run.scene};
  for (const auto& [name, value] : run.options)
    words.push_back(value.empty() ? "--" + name : fmt::format("--{}={}", name, value));
  // No page: a student's own takes figures and pictures.
  words.insert(words.end(),
               {"--technique", rubric_->technique, "--threads", "1", "-o", folder, "--no-report", "--quiet"});
  return words;
}

std::string CheckRuns::as_found(std::string failure) const {
  for (const HandedFile& file : shown_files_)
    if (const std::string path = fmt::format("{}/{}", shaders_, file.name); failure.starts_with(path + ":"))
      return failure.replace(0, path.size(), one_line(file.place));
  return failure;
}

Expected<Drawing> CheckRuns::make(const Run& run, const std::string& folder, Manner manner) {
  for (const HandedFile& file : shown_files_)
    if (!file.refused.empty() && file.name == fmt::format("function/{}.glsl", run.function))
      return Drawing{{}, file.refused, {}};
  std::vector<std::string> words = words_of(run, folder);
  if (!shaders_.empty()) words.insert(words.end(), {"--shader-dir", shaders_});
  if (manner.timed) words.emplace_back("--timed-as-judged");
  if (!manner.timed && run.function.empty()) words.insert(words.end(), {"--runs", "1"});
  if (manner.values) words.insert(words.end(), {"--aov", values_folder(folder) + "/values.exr"});
  // What is timed shares its process with nothing.
  const auto outcome = process_ && !manner.timed
                           ? process_->run(words)
                           : run_limited(program_beside("gnomon"), words, rubric_->limits);
  if (!outcome) return fail(outcome.error());
  const std::string failure = failure_words(*outcome, rubric_->limits);
  if (outcome->end == Outcome::End::exited && outcome->code == 0) {
    auto result = run.function.empty() ? read_run_result(folder) : read_called(run, folder);
    if (!result) return fail(result.error());
    return Drawing{std::move(*result), {}, {}};
  }
  if (outcome->end == Outcome::End::exited && outcome->code == static_cast<int>(ErrorKind::cannot_write))
    return fail(ErrorKind::cannot_write, failure);  // a full disk is no shader's fault
  const bool disturbed = may_be_disturbed(*outcome);
  if (disturbed && manner.again && !is_shaders_fault(*outcome))
    return fail(ErrorKind::graphics, fmt::format("drawing failed twice: {}", failure));
  return Drawing{{},
                 as_found(failure),
                 excerpt_at(failure, shaders_),
                 outcome->end == Outcome::End::out_of_time,
                 disturbed && !manner.again};
}

Expected<Drawing> CheckRuns::make_undisturbed(const Run& run, const std::string& folder, Manner manner) {
  auto drawing = make(run, folder, manner);
  if (!drawing || !drawing->disturbed) return drawing;
  manner.again = true;
  return make(run, folder, manner);
}

Expected<Drawing> CheckRuns::make_with_ties(const Run& run, const std::string& folder, bool again) {
  auto drawing = make(run, folder, {.values = true, .again = again});
  if (!drawing || !drawing->result) return drawing;
  if (const auto added = add_ties(*drawing->result); !added) return fail(added.error());
  return drawing;
}

Expected<const Drawing*> CheckRuns::draw(const Run& asked) {
  Run run = asked;
  run.cases.clear();  // one call of a function answers all of them
  auto known = std::find_if(made_.begin(), made_.end(), [&](const Made& made) { return made.run == run; });
  const bool again = known != made_.end();
  if (again && !known->drawing.disturbed) return &known->drawing;
  if (!again) known = made_.insert(made_.end(), Made{run, {}});
  const std::string folder = fmt::format("{}/{}", folder_, known - made_.begin());
  auto drawing = make(run, folder, {.values = needs_values(run), .again = again});
  // Few shaders draw anything halfway, so few are drawn twice.
  if (drawing && drawing->result && drawing->result->ties > 0 && needs_sides(run))
    drawing = make_with_ties(run, folder, again);
  if (!drawing) {
    if (!again) made_.pop_back();
    return fail(drawing.error());
  }
  known->drawing = std::move(*drawing);
  return &known->drawing;
}

Expected<void> CheckRuns::draw_each(const Run& run, const std::string& shaders,
                                    const std::string& place) const {
  const auto names = names_in(shaders);
  if (!names) return fail(names.error());
  std::vector<std::string> words = words_of(run, place);
  if (run.function.empty()) words.insert(words.end(), {"--aov", place + "/values.exr"});
  Limits limits = rubric_->limits;
  limits.seconds *= static_cast<double>(names->size());
  for (const bool again : {false, true}) {
    const auto outcome = run_limited(program_beside("gnomon"), words, limits,
                                     fmt::format("{}={}", raster::each_folder_variable, shaders));
    if (!outcome) return fail(outcome.error());
    if (outcome->end == Outcome::End::exited && outcome->code == static_cast<int>(ErrorKind::cannot_write))
      return fail(ErrorKind::cannot_write, failure_words(*outcome, limits));
    if (!may_be_disturbed(*outcome) || is_shaders_fault(*outcome)) break;
    if (again) return fail(ErrorKind::graphics, "drawing failed twice: " + failure_words(*outcome, limits));
  }
  return {};
}

Expected<Drawing> CheckRuns::draw_own_with_bias(const Run& run, double bias) const {
  Run with_bias = run;
  std::erase_if(with_bias.options, [](const auto& option) { return option.first == "bias"; });
  with_bias.options.emplace_back("bias", fmt::format("{}", bias));
  return CheckRuns(*rubric_, "", folder_).make_undisturbed(with_bias, folder_ + "/own", {});
}

Expected<Drawing> CheckRuns::draw_timed(const Run& run) {
  return make_undisturbed(run, folder_ + "/timed", {.timed = true, .values = true});
}

}  // namespace gnomon::grade
