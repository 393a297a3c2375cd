// gnomon check: every scene of a gnomon.toml, held against its limits and against a baseline.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/commands.h"
#include "app/console.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/setting_options.h"
#include "app/options/view_options.h"
#include "app/outputs/annotations.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/strongest_lights.h"
#include "app/wrong_words.h"
#include "compare/result/option_names.h"
#include "scene/base/run_program.h"
#include "scene/base/threads.h"
#include "scene/files/encodings.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_files.h"
#include "scene/files/write_file.h"
#include "studies/check/config.h"
#include "studies/check/verdict.h"
#include "studies/diff/words.h"

namespace gnomon::app {

namespace {

using studies::CheckConfig;
using studies::CheckedRun;
using studies::CheckRun;
using studies::ConfigValue;

struct CheckCommand {
  std::vector<std::string> names;
  std::string config = "gnomon.toml", folder = "out/check", baseline, json;
  Annotate annotate;
  int jobs = 0;
  bool resume = false, explain = false, quiet = false;
};

/// compare's options that a configuration may set, bound as compare binds them.
struct ComparedSettings : RunOptions {
  SceneArgument scene;
  SettingOptions setting;
  ViewListOptions views;
  std::string camera, shader_folder;
  std::optional<int> runs;
  int max_lights = usual_max_lights, tessellate = 0;
  MemoryLimit memory;
  CLI::App app;

  ComparedSettings() {
    app.set_help_flag();
    add_scene_time(app, scene);
    add_setting_options(app, setting);
    add_view_options(app, views);
    add_camera(app, camera);
    add_tessellate(app, tessellate);
    add_max_lights(app, max_lights);
    add_run_options(app, *this);
    add_memory(app, memory, scene.memory);
    add_shader_dir(app, shader_folder);
    add_runs(app, runs, "compare's");
  }
};

/// The value as compare's words.
std::vector<std::string> words_of(const ConfigValue& value, const CLI::App& app) {
  const CLI::Option* option = app.get_option_no_throw("--" + value.key);
  if (option != nullptr && is_flag(*option))
    return value.text == "on" ? std::vector{"--" + value.key} : std::vector<std::string>{};
  return {fmt::format("--{}={}", value.key, value.text)};
}

Expected<void> check_value(const CheckConfig& config, const ConfigValue& value) {
  ComparedSettings settings;
  const CLI::Option* option = settings.app.get_option_no_throw("--" + value.key);
  if (option != nullptr && is_flag(*option) && value.text != "on" && value.text != "off")
    return fail(config.wrong(
        value, fmt::format("not a switch's value (got {}, allowed true, false)", printable(value.text))));
  std::vector<std::string> words = words_of(value, settings.app);
  if (studies::is_limit(value.key)) return fail(config.wrong(value, "is a limit, and belongs to limits"));
  if (option == nullptr) words = {"--" + value.key};
  try {
    settings.app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return fail(config.wrong(value, parse_failure_text(settings.app, error)));
  }
  return {};
}

Expected<std::optional<compare::Threshold>> limit_of(const CheckConfig& config, const CheckRun& run,
                                                     std::string_view key) {
  for (const ConfigValue& value : run.limits) {
    if (value.key != key) continue;
    const auto limit = parse_threshold(value.text, compare::wrong_and_mean());
    if (!limit) return fail(config.wrong(value, limit.error().reason));
    return *limit;
  }
  return std::nullopt;
}

Expected<void> check_run(const CheckConfig& config, const CheckRun& run) {
  for (const ConfigValue& value : run.settings)
    if (auto fine = check_value(config, value); !fine) return fine;
  for (const char* key : {"fail-above", "fail-worse"})
    if (auto limit = limit_of(config, run, key); !limit) return fail(limit.error());
  return {};
}

/// Those that were named; all where none was.
Expected<void> choose_runs(const CheckCommand& command, CheckConfig& config) {
  if (command.names.empty()) return {};
  std::vector<std::string_view> known;
  for (const CheckRun& run : config.runs) known.push_back(run.name);
  for (const std::string& name : command.names)
    if (std::ranges::find(known, name) == known.end())
      return fail(ErrorKind::usage,
                  fmt::format("{} has no {}{}", config.path, printable(name), did_you_mean(name, known)));
  std::erase_if(config.runs, [&](const CheckRun& run) {
    return std::ranges::find(command.names, run.name) == command.names.end();
  });
  return {};
}

std::string explain(const CheckConfig& config) {
  std::string text;
  const auto line = [&](const ConfigValue& value) {
    text +=
        fmt::format("  {:20} {:24} {}:{}:{}\n", value.key, value.text, config.path, value.line, value.column);
  };
  for (const CheckRun& run : config.runs) {
    text += run.name + "\n";
    line(run.place);
    for (const ConfigValue& value : run.settings) line(value);
    for (const ConfigValue& value : run.limits) line(value);
  }
  return text;
}

std::vector<std::string> compare_words(const CheckCommand& command, const CheckRun& run, int threads) {
  const ComparedSettings settings;
  std::vector<std::string> words{"compare", run.scene};
  bool names_threads = false;
  for (const ConfigValue& value : run.settings) {
    for (std::string& word : words_of(value, settings.app)) words.push_back(std::move(word));
    names_threads |= value.key == "threads";
  }
  for (const ConfigValue& value : run.limits)
    if (value.key == "fail-above") words.push_back("--fail-above=" + value.text);
  if (!names_threads) words.push_back(fmt::format("--threads={}", threads));
  words.insert(words.end(), {"-o", command.folder + "/" + run.name});
  return words;
}

/// Whether the folder has the result of the same words, by the same program, of a scene's file as it is now.
bool is_done(const CheckCommand& command, const CheckRun& run, const std::vector<std::string>& words) {
  const auto text = read_file(command.folder + "/" + run.name + "/result.json");
  if (!text) return false;
  const auto result = nlohmann::json::parse(*text, nullptr, false);
  if (!result.is_object()) return false;
  std::string line = "gnomon";
  for (const std::string& word : words) line += " " + shell_quoted(word);
  const auto scene = read_file(run.scene), page = read_file(command.folder + "/" + run.name + "/report.html");
  return page && result.value("command", "") == line &&
         result.value("version", "") == compare::program_version() &&
         (!scene || result.value("/scene/sha256"_json_pointer, "") == sha256_hex(*scene));
}

/// The line that says what went wrong.
std::string why_of(const std::string& said, std::string_view part) {
  std::istringstream lines(said);
  std::string why;
  for (std::string line; std::getline(lines, line);)
    if (line.find(part) != std::string::npos) why = line;
  constexpr std::string_view prefix = "gnomon: ";
  return why.starts_with(prefix) ? why.substr(prefix.size()) : why;
}

std::string baseline_of(const CheckCommand& command, const CheckConfig& config) {
  return command.baseline.empty() ? config.baseline.value_or("") : command.baseline;
}

/// What changed since the baseline, and whether that is too much.
Expected<void> compare_with_baseline(const CheckCommand& command, const CheckConfig& config,
                                     const CheckRun& run, CheckedRun& checked) {
  const std::string baseline = baseline_of(command, config);
  if (baseline.empty()) return {};
  const std::string before = baseline + "/" + run.name, after = command.folder + "/" + run.name;
  const auto there = is_there(before + "/result.json");
  if (!there) return fail(there.error());
  if (!*there) return {};
  studies::DiffOptions options;
  options.fail_worse = *limit_of(config, run, "fail-worse");
  options.if_changed = "make the baseline anew";
  auto diff = studies::diff_results(before, after, options);
  if (!diff) return fail(diff.error());
  {
    const OutputGuard whole_outputs;
    if (auto written = studies::write_diff(*diff, after + "/diff", {}); !written) return written;
  }
  for (const studies::LightDiff& light : diff->lights)
    if (!light.too_much.empty()) {
      checked.outcome = CheckedRun::Outcome::exceeded, checked.code = 1;
      checked.why += (checked.why.empty() ? "" : "; ") + light.too_much;
    }
  checked.diff = std::move(*diff);
  return {};
}

std::string limits_text(const CheckRun& run) {
  std::string text;
  for (const ConfigValue& value : run.limits)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", value.key, value.text);
  return text;
}

void fail_run(CheckedRun& checked, const Error& error) {
  checked.outcome = CheckedRun::Outcome::failed;
  checked.code = int(error.kind), checked.why = error.message();
}

/// A comparison is a process of its own: one that ends badly takes no other with it.
Expected<void> make_result(const CheckCommand& command, const CheckRun& run, int threads,
                           CheckedRun& checked) {
  std::vector<std::string> words = compare_words(command, run, threads);
  checked.was_there = command.resume && is_done(command, run, words);
  if (checked.was_there) return {};
  words.insert(words.begin(), program_beside("gnomon"));
  const auto end = run_and_listen(std::move(words));
  if (!end) return fail(end.error());
  checked.code = end->code;
  if (end->code <= 1) return {};
  checked.outcome = CheckedRun::Outcome::failed;
  checked.why = why_of(end->said, "");
  return {};
}

/// Holds the figures that are there against the limit, as compare has.
Expected<void> hold_limit(const CheckCommand& command, const CheckConfig& config, const CheckRun& run,
                          CheckedRun& checked) {
  const std::string result = command.folder + "/" + run.name + "/result.json";
  const auto lights = studies::light_figures(result);
  if (!lights) return fail(lights.error());
  const auto limit = limit_of(config, run, "fail-above");
  const compare::Figure& measure = *limit ? *(*limit)->measure : compare::wrong_and_mean();
  checked.worst = *std::ranges::max_element(
      *lights, {}, [&](const auto& light) { return compare::ranked(measure.of(light)); });
  if (!*limit || compare::is_kept(**limit, *lights)) return {};
  checked.outcome = CheckedRun::Outcome::exceeded, checked.code = 1;
  const bool by_error =
      std::ranges::any_of(*lights, [&](const auto& light) { return compare::exceeds(**limit, light); });
  checked.why =
      by_error
          ? compare::excess_words(**limit, *checked.worst, "fail-above " + compare::threshold_text(**limit))
          : fmt::format("too many pixels are uncertain for {}", compare::threshold_text(**limit));
  return {};
}

CheckedRun checked_run(const CheckCommand& command, const CheckConfig& config, const CheckRun& run,
                       int threads) {
  CheckedRun checked;
  checked.name = run.name, checked.scene = run.scene, checked.limits = limits_text(run);
  if (auto made = make_result(command, run, threads, checked); !made) fail_run(checked, made.error());
  if (checked.outcome == CheckedRun::Outcome::failed) return checked;
  if (auto held = hold_limit(command, config, run, checked); !held) {
    fail_run(checked, held.error());
    return checked;
  }
  if (auto compared = compare_with_baseline(command, config, run, checked); !compared)
    fail_run(checked, compared.error());
  return checked;
}

std::vector<CheckedRun> check_all(const CheckCommand& command, const CheckConfig& config, Console& console) {
  const std::size_t runs = config.runs.size(), processors = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t jobs = std::min(runs, command.jobs > 0 ? std::size_t(command.jobs) : processors);
  const int threads = int(std::max<std::size_t>(1, processors / jobs));
  std::vector<CheckedRun> checked(runs);
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex speaking;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs; i = next++) {
      checked[i] = checked_run(command, config, config.runs[i], threads);
      const std::lock_guard one(speaking);
      console.progress("checking", double(++done) / double(runs));
    }
  };
  std::vector<std::future<void>> workers;
  while (workers.size() + 1 < jobs) workers.push_back(in_background(work));
  work();
  for (std::future<void>& worker : workers) worker.get();
  return checked;
}

std::vector<Annotation> annotations_of(const std::vector<CheckedRun>& runs) {
  std::vector<Annotation> all;
  for (const CheckedRun& run : runs)
    all.push_back({static_cast<Annotation::Outcome>(run.outcome), run.scene, run.name,
                   !run.why.empty() ? run.why
                   : run.diff       ? studies::verdict_text(*run.diff)
                                    : "kept"});
  return all;
}

/// A baseline that is written over says nothing of what changed.
Expected<void> check_baseline(const CheckCommand& command, const CheckConfig& config) {
  namespace fs = std::filesystem;
  const std::string baseline = baseline_of(command, config);
  std::error_code none;
  if (baseline.empty() || fs::weakly_canonical(baseline, none) != fs::weakly_canonical(command.folder, none))
    return {};
  return fail(ErrorKind::usage, fmt::format("-o: this is the baseline, with which nothing could be compared "
                                            "then; --baseline none makes it anew (got {})",
                                            command.folder));
}

Expected<ExitCode> run_check(const CheckCommand& command) {
  Console console(command.quiet);
  auto config = studies::read_check_config(command.config);
  if (!config) return fail(config.error());
  for (const CheckRun& run : config->runs)
    if (auto fine = check_run(*config, run); !fine) return fail(fine.error());
  if (auto chosen = choose_runs(command, *config); !chosen) return fail(chosen.error());
  if (command.explain) return print_data(explain(*config)), ExitCode::done;
  if (auto apart = check_baseline(command, *config); !apart) return fail(apart.error());
  RunFiles files;
  files.reads(command.config);
  files.writes("--json", command.json);
  files.writes("--annotate", command.annotate.path);
  files.writes_folder("-o", command.folder, std::array<std::string_view, 2>{"report.html", "check.json"});
  if (auto fine = files.check(); !fine) return fail(fine.error());
  const std::vector<CheckedRun> runs = check_all(command, *config, console);
  console.clear_progress();
  const std::string json = studies::check_json(runs, command.config);
  const OutputGuard whole_outputs;
  if (auto written = studies::write_check(runs, command.config, command.folder,
                                          command.json == "-" ? std::string() : command.json);
      !written)
    return fail(written.error());
  if (command.json == "-") print_data(json);
  if (!command.quiet && command.json != "-") print_data(studies::check_table(runs));
  if (auto put = put_annotations(command.annotate, "check", annotations_of(runs)); !put)
    return fail(put.error());
  console.message(fmt::format("check: {}/report.html", command.folder));
  ExitCode code = ExitCode::done;
  for (const CheckedRun& run : runs) {
    if (run.outcome == CheckedRun::Outcome::failed)
      return fail(static_cast<ErrorKind>(std::clamp(run.code, 2, 6)),
                  fmt::format("{}: {}", run.name, run.why));
    if (run.outcome == CheckedRun::Outcome::exceeded) code = ExitCode::threshold_exceeded;
  }
  return code;
}

void add_options(CLI::App& app, CheckCommand& command) {
  app.add_option("NAME", command.names, "which of the configuration's scenes [default: all]")
      ->type_name("NAME");
  add_name(app, "--config", command.config, "FILE.toml",
           "what is checked: scenes, views, settings, limits (docs/ci.md) [default gnomon.toml]");
  add_output(
      app, "-o,--output", command.folder, "DIR",
      "folder for report.html, check.json, and a folder of compare's for each scene [default out/check]");
  add_name(app, "--baseline", command.baseline, "DIR",
           "folder of an earlier check, which limits of fail-worse are held against [default the "
           "configuration's]");
  add_integer(app, "--jobs", command.jobs, 0, 256, "0: one for each processor", "scenes compared at a time");
  app.add_flag(
      "--resume", command.resume,
      "keep what an earlier check left in the folder, where words, program and the scene's file are the "
      "same; files that the scene names are not looked at [default off]");
  app.add_flag("--explain", command.explain,
               "print each value and its place in the configuration, and compare nothing [default off]");
  add_annotate(app, command.annotate);
  add_json(app, command.json, "the verdicts");
  add_quiet(app, command.quiet);
}

}  // namespace

GNOMON_COMMAND(check, 146,
               "Compare every scene of a gnomon.toml, and hold each against its limits and a baseline.") {
  app->footer(
      "gnomon check                                  gnomon.toml, here\n"
      "gnomon check hall --explain                   where each value comes from\n"
      "gnomon check --baseline baseline --annotate junit:shadows.xml --quiet");
  const auto command = std::make_shared<CheckCommand>();
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_check);
}

}  // namespace gnomon::app
