// gnomon judge: what another renderer drew, in the place of Gnomon's own picture. Its folder is that of compare.
#include "judge/judge.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/outputs/result_output.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "judge/commands/captures.h"
#include "judge/commands/judge_options.h"
#include "judge/identify.h"
#include "judge/recorded_frame.h"
#include "judge/several.h"
#include "scene/base/stages.h"
#include "scene/files/staged_folder.h"

namespace gnomon::app {

namespace {

struct JudgeCommand : RunOptions {
  std::vector<std::string> captures;
  CaptureOptions parts;
  judge::JudgeOptions options;
  ResultOutput output;
  bool identify = false;
  std::string suite;
  bool list = false;
  std::string command_line;
};

struct JudgedScene {
  LoadedScene loaded;
  compare::Comparison comparison;
};

Expected<void> identify_map(const JudgeCommand& command, JudgedScene& judged, Console& console) {
  if (judged.comparison.judged->has_map) {
    console.note("--identify looks for nothing: the capture has its map");
    return {};
  }
  auto renderer = make_renderer(command.backend, judged.loaded, console);
  if (!renderer) return fail(renderer.error());
  return judge::identify(
      judged.comparison, **renderer,
      {command.options.accel, command.options.precision, command.options.bias_curve_points},
      [&](std::string_view stage, double done) { console.progress(stage, done); });
}

Expected<JudgedScene> judge_one(const JudgeCommand& command, const judge::Capture& capture, RunFiles& files,
                                Console& console) {
  JudgedScene out;
  auto loaded = load({capture.scene}, files, console, 0, capture.camera);
  if (!loaded) return fail(loaded.error());
  out.loaded = std::move(*loaded);
  if (command.exposure) out.loaded.scene->exposure = *command.exposure;
  auto comparison =
      judge::judge_capture(capture, *out.loaded.scene, *out.loaded.world, command.options,
                           [&](std::string_view stage, double done) { console.progress(stage, done); });
  if (!comparison)
    return fail(capture.path.empty() ? named_by_option(comparison.error(), command.parts)
                                     : comparison.error());
  out.comparison = std::move(*comparison);
  if (command.identify)
    if (const auto done = identify_map(command, out, console); !done) return fail(done.error());
  out.comparison.command = command.command_line;
  out.comparison.seed = command.seed;
  out.comparison.machine = machine_info();
  out.comparison.fail_above = command.output.fail_above;
  out.comparison.measure = command.output.measure;
  out.comparison.load_ms = out.loaded.load_ms;
  out.comparison.peak_memory_bytes = peak_memory_bytes();
  for (const compare::Mended& mended : out.comparison.judged->mended)
    console.note(fmt::format("{}: {:.2f} % of the {} agree, undone {:.2f} %", mended.what,
                             100.0 * mended.before, mended.evidence, 100.0 * mended.after));
  for (const std::string& note : out.comparison.judged->notes) console.note(note);
  return out;
}

Expected<ExitCode> list_lights(const JudgeCommand& command, Console& console) {
  const std::string word = command.captures.size() == 1 ? command.captures.front() : "";
  if (!judge::is_recorded_frame(word) && !judge::is_page(word))
    return fail(ErrorKind::usage,
                "--list: needs one frame that RenderDoc recorded (.rdc), or the address of a page");
  std::optional<PageFrame> frame;
  if (judge::is_page(word))
    if (const auto recorded = record_frame(word, frame.emplace(), console); !recorded)
      return fail(recorded.error());
  const auto lights = judge::recorded_lights(frame ? frame->path() : word);
  if (!lights) return fail(lights.error());
  for (const std::string& light : *lights) print_data(light + "\n");
  return ExitCode::done;
}

Expected<ExitCode> judge_single(JudgeCommand& command, const judge::Capture& capture, Console& console) {
  const Stopwatch total;
  if (command.output.folder.empty() && !only_prints_json(command.output))
    command.output.folder =
        capture.path.empty() ? default_output(capture.scene) : "out/" + name_of(capture.path);
  RunFiles files = inputs_of(capture);
  files.writes("--trace", command.trace);
  if (const auto fine = check_outputs(command.output, files); !fine) return fail(fine.error());
  auto judged = judge_one(command, capture, files, console);
  if (!judged) return fail(judged.error());
  judged->comparison.total_ms = total.elapsed_ms();
  console.progress("writing", 1.0);
  if (only_prints_json(command.output))
    return print_result(command.output, judged->comparison, judged->loaded, console);
  return write_folder(command.output, judged->comparison, judged->loaded, files, total, console);
}

/// Its own folder below the common one, which is still in the making at `place`.
ResultOutput folder_output(const JudgeCommand& command, const NamedCapture& named, const std::string& place) {
  ResultOutput output = command.output;
  output.shown_folder = output.folder + "/" + named.name;
  output.folder = place + "/" + named.name, output.quiet = true;
  return output;
}

/// No capture's folder takes the place of what the capture names. One that cannot be read is refused in its turn.
Expected<void> check_folders(const JudgeCommand& command, const std::vector<NamedCapture>& captures) {
  for (const NamedCapture& named : captures) {
    if (!named.capture) continue;
    RunFiles files = inputs_of(*named.capture);
    if (const auto fine = check_outputs(folder_output(command, named, command.output.folder), files); !fine)
      return fine;
  }
  return {};
}

/// What several captures become: pages in the making, and files that these must not replace.
struct SetInTheMaking {
  StagedFolder staged;
  judge::JudgedSet set{};
  std::vector<std::string> inputs{};
  std::vector<Annotation> annotations{};
};

Expected<ExitCode> judge_next(JudgeCommand& command, const NamedCapture& named, SetInTheMaking& making,
                              Console& console) {
  const Stopwatch total;
  if (!named.capture) return fail(named.capture.error());
  ResultOutput output = folder_output(command, named, making.staged.path());
  std::vector<Annotation> annotations;
  output.annotations = &annotations;
  RunFiles files = inputs_of(*named.capture);
  if (const auto fine = check_outputs(output, files); !fine) return fail(fine.error());
  auto judged = judge_one(command, *named.capture, files, console);
  if (!judged) return fail(judged.error());
  judged->comparison.total_ms = total.elapsed_ms();
  making.set.add(named.name, judged->comparison);
  making.inputs.insert(making.inputs.end(), files.inputs().begin(), files.inputs().end());
  auto code = write_folder(output, judged->comparison, judged->loaded, files, total, console);
  for (Annotation& light : annotations) {
    light.about = named.name;
    making.annotations.push_back(std::move(light));
  }
  return code;
}

Expected<void> publish_set(SetInTheMaking& making) {
  const OutputGuard whole_outputs;
  if (auto written = judge::write_judged_set(making.set, making.staged.path()); !written) return written;
  if (auto sealed = making.staged.seal(making.inputs); !sealed) return sealed;
  return making.staged.publish("report.html");
}

Expected<SetInTheMaking> begin_set(const std::string& folder) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  return SetInTheMaking{std::move(*staged)};
}

Expected<ExitCode> judge_several(JudgeCommand& command, const std::vector<NamedCapture>& captures,
                                 Console& console) {
  if (command.output.folder.empty())
    command.output.folder =
        command.captures.size() == 1 ? "out/" + name_of(command.captures.front()) : "out/judge";
  if (!command.output.json.empty() || !command.output.aov.empty())
    return fail(ErrorKind::usage,
                "judge: --json and --aov are of one light (--light chooses it); several write judge.jsonl");
  RunFiles files;
  for (const std::string& path : command.captures) files.reads(path);
  files.writes("--trace", command.trace);
  if (const auto fine = check_outputs(command.output, files); !fine) return fail(fine.error());
  if (const auto apart = check_folders(command, captures); !apart) return fail(apart.error());
  auto making = begin_set(command.output.folder);
  if (!making) return fail(making.error());
  ExitCode code = ExitCode::done;
  std::optional<Error> refused;
  for (const NamedCapture& named : captures) {
    const auto judged = judge_next(command, named, *making, console);
    if (judged && *judged != ExitCode::done) code = *judged;
    if (judged) continue;
    if (judged.error().kind != ErrorKind::bad_input) return fail(judged.error());
    if (refused) console.message(refused->message());
    refused = judged.error();
    making->set.add_refused(named.name, refused->message());
    making->annotations.push_back({Annotation::Outcome::failed, named.name, "capture", refused->message()});
  }
  if (const auto published = publish_set(*making); !published) return fail(published.error());
  if (auto put = put_annotations(command.output.annotate, "judge", making->annotations); !put)
    return fail(put.error());
  if (!command.output.quiet) print_data(judge::judged_table(making->set));
  console.message("report: " + command.output.folder + "/report.html");
  if (refused) return fail(*refused);
  return code;
}

Expected<ExitCode> run_judge(JudgeCommand& command) {
  Console console(command.output.quiet);
  command.options.raytrace.seed = command.seed;
  if (command.captures.empty() && command.suite.empty() && !command.parts.any)
    return fail(ErrorKind::usage, "judge: needs a capture (a file, or its parts as options)");
  if (command.list) return list_lights(command, console);
  if (const auto made = make_captures(command.captures, command.suite.empty(), command.parts,
                                      command.output.folder, console);
      !made)
    return fail(made.error());
  if (!command.suite.empty()) {
    auto found = captures_below(command.suite);
    if (!found) return fail(found.error());
    command.captures.insert(command.captures.end(), found->begin(), found->end());
  }
  if (command.captures.size() > 1 || !command.suite.empty())
    return judge_several(command, all_lights(command.captures, command.parts), console);
  const auto lights = lights_of(command.parts, command.captures.empty() ? "" : command.captures.front());
  if (!lights) return fail(lights.error());
  if (lights->size() > 1) return judge_several(command, all_lights(command.captures, command.parts), console);
  return judge_single(command, lights->front(), console);
}

void add_options(CLI::App& app, JudgeCommand& command) {
  app.add_option(
         "CAPTURE", command.captures,
         "captures (gnomon/capture/2 or 1, docs/judge.md); frames that RenderDoc recorded, or web pages "
         "of your own, whose captures are made in a folder beside the verdict's [may be left out where "
         "the options say it all]")
      ->type_name("CAPTURE.json|FRAME.rdc|URL");
  app.add_flag("--list", command.list,
               "print the lights of a recorded frame that have a shadow map; --light N judges that one alone "
               "[default off]");
  add_result_output(app, command.output, "out/NAME of the capture, out/judge of several");
  app.add_option(
         "--suite", command.suite,
         "judge every capture.json in this folder and in those below it, such as captures of the scenes that "
         "gnomon export --suite wrote [default off]")
      ->type_name("DIR");
  app.add_flag(
      "--fix", command.options.fix,
      "undo what is wrong with the picture's conventions (named, with the agreement before and after) "
      "[default: exit code 3]");
  app.add_flag(
      "--identify", command.identify,
      "of a capture without its map: find the setting of Gnomon's own that comes nearest to the picture, "
      "and label by it [default off]");
  add_engine(app, command.options.engine, "give advice in this engine's settings, too",
             "the engine that the renderer's name begins with");
  add_run_options(app, command);
  add_capture_options(app, command.parts);
  add_samples(app, command.options.raytrace.shadow_samples);
  add_tracer_options(app, command.options.accel, command.options.precision);
  add_result_limits(app, command.output);
}

}  // namespace

GNOMON_COMMAND(
    judge, 140,
    "Take the shadow that another renderer drew, and report where it differs from the truth and why.") {
  app->footer(
      "gnomon judge capture.json -o report\n"
      "gnomon judge capture.json --fix --fail-above 1%\n"
      "gnomon judge a.json b.json -o verdicts      one table, the worst first\n"
      "gnomon judge frame.json --light sun         one of a capture's lights\n"
      "gnomon judge frame.rdc --light 2            of any engine, by RenderDoc\n"
      "gnomon judge http://localhost:8000/         a web page of your own\n"
      "gnomon judge --renderer mine --scene model.glb --size 640x360 --visibility shadow.png");
  const auto command = std::make_shared<JudgeCommand>();
  command->command_line = invocation.command_line;
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_judge);
}

}  // namespace gnomon::app
