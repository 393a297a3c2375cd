// Where the result of a comparison goes: the folder with its page, result.json on stdout or in a file, the
// channels; and the exit code that --fail-above asks for.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/invocation.h"
#include "app/outputs/annotations.h"
#include "app/session.h"
#include "compare/measure/measure.h"
#include "report/write_outputs.h"
#include "scene/base/timing.h"

namespace gnomon::app {

struct ResultOutput {
  std::string folder, json, aov;
  std::string shown_folder{};  ///< what messages call the folder; empty: by its path
  const compare::Figure* measure = &compare::wrong_and_mean();  ///< what errors are counted in
  std::optional<compare::Threshold> fail_above;
  double report_max_mb = report::default_report_max_mb;
  Annotate annotate;
  std::vector<Annotation>* annotations = nullptr;  ///< of several results, which are put together
  bool no_report = false;                          ///< no page; all other files as ever
  bool quiet = false, verbose = false;
  bool verdict_is_said = false;  ///< by say_verdict()
};

/// -o; `default_folder` as its help says it.
void add_result_output(CLI::App& app, ResultOutput& output, const std::string& default_folder);
/// --report-max-mb, --measure, --fail-above, --annotate, --aov, --json, --verbose, --quiet.
void add_result_limits(CLI::App& app, ResultOutput& output);

/// Adds them to what the run writes. Error where one cannot be written or would take another file's place,
/// before anything is worked out.
Expected<void> check_outputs(const ResultOutput& output, RunFiles& files);
/// Nothing but the result on stdout was asked for: no folder is written.
bool only_prints_json(const ResultOutput& output);

/// Prints verdict and advice where the short summary is to be printed, as soon as they are known.
void say_verdict(ResultOutput& output, const compare::Comparison& comparison, Console& console);

/// --json - alone: the result goes to stdout and nowhere else. Both give scene and comparison back before the
/// time budget is taken.
Expected<ExitCode> print_result(const ResultOutput& output, compare::Comparison& comparison,
                                LoadedScene& loaded, Console& console);
/// `parts`: of a comparison in bands.
Expected<ExitCode> write_folder(const ResultOutput& output, compare::Comparison& comparison,
                                LoadedScene& loaded, const RunFiles& files, const Stopwatch& total,
                                Console& console, std::unique_ptr<compare::BandedParts> parts = nullptr);

}  // namespace gnomon::app
