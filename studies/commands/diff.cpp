// gnomon diff: two results of one scene, and what became better or worse.
#include "studies/diff/diff.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/outputs/annotations.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "scene/files/write_file.h"
#include "studies/diff/words.h"

namespace gnomon::app {

namespace {

struct DiffCommand {
  std::vector<std::string> results;
  std::string baseline, folder, json;
  studies::DiffOptions options;
  Annotate annotate;
  bool quiet = false;
};

/// Before, after.
Expected<std::pair<std::string, std::string>> results_of(const DiffCommand& command) {
  std::vector<std::string> all = command.results;
  if (!command.baseline.empty()) all.insert(all.begin(), command.baseline);
  if (all.size() == 2) return std::pair{all[0], all[1]};
  return fail(ErrorKind::usage,
              fmt::format("diff: needs two results, or one and --baseline (got {})", all.size()));
}

std::vector<Annotation> annotations_of(const studies::Diff& diff) {
  std::vector<Annotation> all;
  for (const studies::LightDiff& light : diff.lights) {
    const bool exceeded = !light.too_much.empty();
    all.push_back({exceeded ? Annotation::Outcome::exceeded : Annotation::Outcome::kept, diff.scene,
                   "light " + light.name,
                   exceeded ? light.too_much
                            : fmt::format("{}; pixels: {}", studies::trend_name(light.trend),
                                          studies::pixels_text(light))});
  }
  return all;
}

Expected<ExitCode> run_diff(const DiffCommand& command) {
  Console console(command.quiet);
  const auto results = results_of(command);
  if (!results) return fail(results.error());
  RunFiles files;
  files.writes("--json", command.json);
  files.writes("--annotate", command.annotate.path);
  files.writes_folder("-o", command.folder, std::array<std::string_view, 2>{"report.html", "diff.json"});
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto diff = studies::diff_results(results->first, results->second, command.options);
  if (!diff) return fail(diff.error());
  for (const std::string& note : diff->notes) console.note(note);
  const OutputGuard whole_outputs;
  if (command.json == "-") print_data(studies::diff_json(*diff));
  const std::string json = command.json == "-" ? std::string() : command.json;
  if (!command.folder.empty()) {
    if (auto written = studies::write_diff(*diff, command.folder, json); !written)
      return fail(written.error());
  } else if (!json.empty()) {
    if (auto written = write_file(json, studies::diff_json(*diff)); !written) return fail(written.error());
  }
  if (!command.quiet && command.json != "-") print_data(studies::diff_text(*diff));
  for (const studies::LightDiff& light : diff->lights)
    if (!light.too_much.empty())
      console.message(fmt::format("light {}; that is more than --fail-worse {} allows", light.too_much,
                                  compare::threshold_text(*command.options.fail_worse)));
  if (!command.folder.empty()) console.message(fmt::format("diff: {}/report.html", command.folder));
  if (auto put = put_annotations(command.annotate, "diff", annotations_of(*diff)); !put)
    return fail(put.error());
  return diff->too_much() ? ExitCode::threshold_exceeded : ExitCode::done;
}

void add_options(CLI::App& app, DiffCommand& command) {
  app.add_option("RESULT", command.results,
                 "before and after: a folder that compare or judge wrote, or its result.json")
      ->type_name("DIR|FILE.json");
  add_name(app, "--baseline", command.baseline, "DIR|FILE.json",
           "the result before, in the place of the first [default: the first of two]");
  add_output(app, "-o,--output", command.folder, "DIR",
             "folder for report.html and diff.json [default: none is written]");
  add_measured_limit(
      app, "--fail-worse", {command.options.measure, command.options.fail_worse},
      "exit with 1 when the error of any light has grown by more than this, and by more than chance",
      "never");
  app.add_flag("--changed-scene", command.options.changed_scene,
               "compare them though the scene's file has changed in between [default off]");
  add_annotate(app, command.annotate);
  add_json(app, command.json, "the diff");
  add_quiet(app, command.quiet);
}

}  // namespace

GNOMON_COMMAND(diff, 145, "Say what became better or worse between two results of one scene, and where.") {
  app->footer(
      "gnomon diff baseline/fence out/fence\n"
      "gnomon diff out/fence --baseline baseline/fence -o out/diff\n"
      "gnomon diff before.json after.json --fail-worse 0.1% --quiet    for scripts: exit code 1");
  const auto command = std::make_shared<DiffCommand>();
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_diff);
}

}  // namespace gnomon::app
