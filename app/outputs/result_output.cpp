#include "app/outputs/result_output.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "app/options/options.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "report/page.h"
#include "scene/base/freed_memory.h"
#include "scene/base/stages.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::app {
namespace {

/// With several lights the channels go into files whose names are known only now.
Expected<void> check_aov(const ResultOutput& output, const compare::Comparison& comparison, RunFiles files) {
  if (output.aov.empty() || comparison.lights.size() < 2) return {};
  for (const compare::LightComparison& light : comparison.lights)
    files.writes("--aov", compare::aov_path(comparison, light, output.aov));
  return files.check();
}

/// The channels, where they wait for the folder.
Expected<void> write_aov(const ResultOutput& output, const compare::Comparison& comparison,
                         report::WrittenOutputs& written, compare::BandedParts* parts) {
  if (output.aov.empty()) return {};
  const TimedStage stage("write");
  std::vector<std::string> places;
  for (const compare::LightComparison& light : comparison.lights) {
    auto place = written.also.place_of(compare::aov_path(comparison, light, output.aov), &written.staged);
    if (!place) return fail(place.error());
    places.push_back(std::move(*place));
  }
  if (parts == nullptr) return compare::write_aov(comparison, places);
  for (std::size_t i = 0; i < parts->channels.size(); ++i)
    if (auto closed = parts->channels[i].close(places[i]); !closed) return closed;
  return {};
}

/// All but result.json.
Expected<report::WrittenOutputs> write_all(const ResultOutput& output, const compare::Comparison& comparison,
                                           const RunFiles& files, Console& console,
                                           compare::BandedParts* parts) {
  if (const auto apart = check_aov(output, comparison, files); !apart) return fail(apart.error());
  auto written = report::write_all_but_result(comparison, parts,
                                              {.folder = output.folder,
                                               .report_max_mb = output.report_max_mb,
                                               .page = !output.no_report,
                                               .inputs = files.inputs()});
  if (!written) return fail(written.error());
  if (written->beside) console.note(beside_note(written->page_mb, output.report_max_mb));
  if (output.json != "-") written->result_copy = output.json;
  if (const auto saved = write_aov(output, comparison, *written, parts); !saved) return fail(saved.error());
  return written;
}

using Outcome = Annotation::Outcome;

/// Holds one light against --fail-above; the words say what is too much, or else how much there is.
Annotation judge_light(const ResultOutput& output, const compare::LightFigures& figures) {
  const std::string found = compare::figure_words(figures, *output.measure);
  if (!output.fail_above) return {.said = found};
  const compare::Threshold& threshold = *output.fail_above;
  const std::string words = compare::figure_words(figures, *threshold.measure);
  const std::string limit = compare::threshold_text(threshold);
  if (compare::exceeds(threshold, figures))
    return {.outcome = Outcome::exceeded,
            .said = compare::excess_words(threshold, figures, "--fail-above " + limit)};
  if (!compare::too_uncertain(threshold, figures)) return {.said = words};
  return {
      .outcome = Outcome::exceeded,
      .said = fmt::format(
          "{} of {} pixels that show a lit or shadowed surface are uncertain, more than --fail-above {} "
          "allows to be wrong: the truth there lies within its own error bound (--precision exact decides "
          "rays; lights with size want more --samples, or a limit of the mean error, such as mean:1%)",
          compare::grouped(compare::unknown_pixels(figures, *threshold.measure)),
          compare::grouped(figures.pixels.compared + figures.pixels.uncertain), limit)};
}

/// One for each light, or one for all where nothing can be said.
std::vector<Annotation> verdicts(const ResultOutput& output, const compare::Comparison& comparison) {
  const Scene& scene = *comparison.world->scene;
  const std::vector<compare::LightFigures> lights = compare::judged_lights(comparison);
  if (output.fail_above && compare::says_nothing(*output.fail_above, lights))
    return {{Outcome::exceeded, scene.name, "all lights",
             fmt::format("{}, so nothing holds against --fail-above {}",
                         scene.is_empty_model ? "the file has no triangles" : "no pixel could be compared",
                         compare::threshold_text(*output.fail_above))}};
  std::vector<Annotation> all;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Annotation light = judge_light(output, lights[i]);
    light.about = scene.name;
    light.name = "light " + scene.lights[comparison.lights[i].light].name;
    all.push_back(std::move(light));
  }
  return all;
}

/// Says what is exceeded. Annotations are left in `annotations`.
ExitCode judge_lights(const ResultOutput& output, const compare::Comparison& comparison,
                      std::vector<Annotation>& annotations, Console& console) {
  ExitCode code = ExitCode::done;
  annotations = verdicts(output, comparison);
  for (const Annotation& verdict : annotations) {
    if (verdict.outcome == Outcome::kept) continue;
    const bool is_light = verdict.name.starts_with("light ");
    console.message(is_light ? verdict.name + ": " + verdict.said : verdict.said);
    code = ExitCode::threshold_exceeded;
  }
  return code;
}

std::string command_of(const compare::Comparison& comparison) {
  return comparison.judged ? "judge" : "compare";
}

/// Several results are put together by who asked for them.
bool gathers(const ResultOutput& output, const std::vector<Annotation>& annotations) {
  if (output.annotations == nullptr) return false;
  output.annotations->insert(output.annotations->end(), annotations.begin(), annotations.end());
  return true;
}

/// Before result.json is written, so that what it takes is in its time budget: the system would take the
/// memory back after the last reading of the clocks otherwise.
void give_back(compare::Comparison& comparison, LoadedScene& loaded) {
  const TimedStage stage("exit");
  comparison = {};
  loaded = {};
  return_freed_memory();
}

bool prints_summary(const ResultOutput& output) {
  return !output.quiet && output.json != "-";
}

/// A page of an earlier run is left as it is, but not in silence.
void note_old_report(const std::string& folder, Console& console) {
  const std::string page = folder + "/report.html";
  if (file_kind_or_none(page) != FileKind::none)
    console.note(page + " is of an earlier run; --no-report leaves it as it is");
}

}  // namespace

Expected<void> check_outputs(const ResultOutput& output, RunFiles& files) {
  if (!output.aov.empty())
    if (const auto known = check_extension("--aov", output.aov, ".exr"); !known) return known;
  files.writes("--aov", output.aov);
  files.writes("--json", output.json);
  files.writes("--annotate", output.annotate.path);
  files.writes_folder("-o", output.folder, report::page_file_names);
  return files.check();
}

bool only_prints_json(const ResultOutput& output) {
  return output.json == "-" && output.folder.empty() && output.aov.empty();
}

void say_verdict(ResultOutput& output, const compare::Comparison& comparison, Console& console) {
  // Where nobody listens, the outputs are there before the program ends of it.
  if (!prints_summary(output) || output.verbose || stdout_has_no_reader()) return;
  console.clear_progress();
  print_data(compare::verdict_in_short(comparison, stdout_takes_colour()));
  output.verdict_is_said = true;
}

Expected<ExitCode> print_result(const ResultOutput& output, compare::Comparison& comparison,
                                LoadedScene& loaded, Console& console) {
  std::vector<Annotation> annotations;
  const ExitCode code = judge_lights(output, comparison, annotations, console);
  const std::string command = command_of(comparison);
  std::string json = compare::result_json(comparison);
  give_back(comparison, loaded);
  print_data(compare::with_time_budget(std::move(json)));
  if (auto put = put_annotations(output.annotate, command, annotations); !put) return fail(put.error());
  return code;
}

Expected<ExitCode> write_folder(const ResultOutput& output, compare::Comparison& comparison,
                                LoadedScene& loaded, const RunFiles& files, const Stopwatch& total,
                                Console& console, std::unique_ptr<compare::BandedParts> parts) {
  std::optional<OutputGuard> whole_outputs(std::in_place);
  auto written = write_all(output, comparison, files, console, parts.get());
  parts.reset();
  if (!written) return fail(written.error());
  const std::string& folder = output.shown_folder.empty() ? output.folder : output.shown_folder;
  const std::string place = (output.no_report ? "Result: " : "Report: ") + folder +
                            (output.no_report ? "/result.json" : "/report.html");
  const bool colour = stdout_takes_colour(), prints = prints_summary(output);
  std::string summary;
  if (output.verbose)
    summary = compare::summary_table(comparison, colour);
  else
    summary = (output.verdict_is_said ? "" : compare::verdict_in_short(comparison, colour)) +
              compare::figures_in_short(comparison, place, colour);
  std::vector<Annotation> annotations;
  const ExitCode code = judge_lights(output, comparison, annotations, console);
  const bool is_one_of_several = gathers(output, annotations);
  if (!is_one_of_several && !output.annotate.path.empty())
    written->elsewhere.push_back(
        {output.annotate.path, annotation_file(output.annotate, command_of(comparison), annotations)});
  give_back(comparison, loaded);
  if (const auto result = report::write_result(*written); !result) return fail(result.error());
  if (output.json == "-") print_data(written->result);
  whole_outputs.reset();
  if (!is_one_of_several) print_annotations(output.annotate, annotations);
  if (const StageLog* log = StageLog::current(); log != nullptr && output.verbose)
    summary += compare::time_budget_text(log->budget(), colour);
  if (prints) print_data(summary);
  if (output.no_report) note_old_report(output.folder, console);
  const std::string took = fmt::format("{:.1f} s, {:.0f} MB of memory at most", total.elapsed_ms() / 1000.0,
                                       static_cast<double>(peak_memory_bytes()) / 1e6);
  console.message(prints && !output.verbose ? took : fmt::format("{} ({})", place, took));
  return code;
}

void add_result_output(CLI::App& app, ResultOutput& output, const std::string& default_folder) {
  add_output(app, "-o,--output", output.folder, "DIR",
             "folder for report.html, result.json, result.csv and the pictures [default " + default_folder +
                 "; none with --json - alone]");
}

void add_result_limits(CLI::App& app, ResultOutput& output) {
  add_report_max_mb(app, output.report_max_mb);
  add_measured_limit(
      app, "--fail-above", {output.measure, output.fail_above},
      "exit with 1 when the error of any light is more than this, or so many pixels are uncertain", "never");
  add_annotate(app, output.annotate);
  add_output(app, "--aov", output.aov, "FILE.exr",
             "also write every per-pixel number as 32-bit channels, one file per light [default off]");
  add_json(app, output.json, "the result");
  add_verbose(app, output.verbose, "also print the budget and all other figures");
  add_quiet(app, output.quiet);
}

}  // namespace gnomon::app
