// gnomon shaders: the rasterizer's GLSL, to be read and edited; --shader-dir takes what was edited. --call tries a function of
// one's own.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/outputs/each_shader.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "functions/functions.h"
#include "raster/programs/shader_folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct ShadersCommand {
  std::string folder;
  std::string function, group, shader_folder, json;  ///< of --call
  raster::Backend backend = raster::Backend::automatic;
  bool quiet = false;
};

/// "technique/pcf_box.glsl      Percentage-closer filtering (Reeves, …)": a file's first comment line.
std::string list_of_shaders() {
  constexpr std::size_t name_column = 28;  // columns
  std::string text;
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string_view line = file.text.substr(0, file.text.find('\n'));
    text += fmt::format("{:<{}}{}\n", file.name, name_column, line.starts_with("// ") ? line.substr(3) : "");
  }
  return text;
}

/// What is there and differs may be somebody's work.
Expected<void> check_nothing_is_lost(const ShadersCommand& command) {
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string path = (std::filesystem::path(command.folder) / file.name).string();
    const auto is = is_there(path, ErrorKind::cannot_write);
    if (!is) return fail(is.error());
    if (!*is) continue;
    const auto there = read_file(path);
    if (there && *there == file.text) continue;
    return fail(Error{ErrorKind::cannot_write,
                      "is there already and differs from the program's own; move it away first", path});
  }
  return {};
}

constexpr const char* named_shader = "technique/hard.glsl";

Expected<void> write_shaders(const std::string& folder) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string path = (std::filesystem::path(staged->path()) / file.name).string();
    if (auto made = make_folder_for(path); !made) return made;
    if (auto written = write_file(path, file.text); !written) return written;
  }
  if (auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish(named_shader);
}

/// "front      11 of 12 right; the ray from ...: answered 2.5, right: no hit".
std::string group_line(const functions::Function& function, std::string_view group,
                       const std::vector<raster::Answer>& answers) {
  const std::vector<functions::Question>& questions = functions::questions_of(function);
  std::size_t cases = 0, right = 0;
  std::string first;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (questions[i].group != group) continue;
    const bool is = functions::is_right(function, questions[i], answers[i]);
    if (!is && first.empty()) first = "; " + functions::answer_words(function, questions[i], answers[i]);
    ++cases, right += is ? 1 : 0;
  }
  return fmt::format("{:<10} {} of {} right{}\n", group, right, cases, first);
}

/// Every case of a group, or a line for each group.
std::string answers_text(const functions::Function& function, const std::string& group,
                         const std::vector<raster::Answer>& answers) {
  std::string text;
  if (group.empty()) {
    for (const std::string_view each : functions::groups_of(function))
      text += group_line(function, each, answers);
    return text;
  }
  const std::vector<functions::Question>& questions = functions::questions_of(function);
  for (std::size_t i = 0; i < questions.size(); ++i)
    if (questions[i].group == group)
      text +=
          fmt::format("{}  {}\n", functions::is_right(function, questions[i], answers[i]) ? "right" : "wrong",
                      functions::answer_words(function, questions[i], answers[i]));
  return text;
}

Expected<void> check_call(const ShadersCommand& command) {
  if (!command.folder.empty())
    return fail(ErrorKind::usage, "--call: goes without -o, which writes the shaders");
  const functions::Function* function = functions::find_function(command.function);
  if (function == nullptr)
    return fail(ErrorKind::usage,
                fmt::format("--call: no such function (got {}, allowed {})", command.function,
                            fmt::join(functions::function_names(), ", ")));
  const std::vector<std::string_view> groups = functions::groups_of(*function);
  if (!command.group.empty() && std::find(groups.begin(), groups.end(), command.group) == groups.end())
    return fail(ErrorKind::usage, fmt::format("--cases: {} is not tried on these (got {}, allowed {})",
                                              function->name, command.group, fmt::join(groups, ", ")));
  RunFiles files;
  files.reads_shaders(command.shader_folder);
  files.writes("--json", command.json);
  return files.check();
}

Expected<ExitCode> run_call(const ShadersCommand& command) {
  if (const auto fine = check_call(command); !fine) return fail(fine.error());
  const functions::Function& function = *functions::find_function(command.function);
  if (is_asked_for_each_shader())
    return for_each_shader(command.json,
                           [&](const std::string& shaders, const std::string& place) -> Expected<void> {
                             const auto answers = functions::ask(function, command.backend, shaders);
                             return answers ? write_file(place, functions::answers_json(function, *answers))
                                            : fail(answers.error());
                           });
  const auto answers = functions::ask(function, command.backend, command.shader_folder);
  if (!answers) return fail(answers.error());
  if (command.json != "-" && !command.quiet) print_data(answers_text(function, command.group, *answers));
  const OutputGuard whole_outputs;
  if (const auto written = hand_out_json(command.json, functions::answers_json(function, *answers)); !written)
    return fail(written.error());
  return ExitCode::done;
}

/// Options that say nothing without --call.
Expected<void> check_no_call(const ShadersCommand& command) {
  const std::pair<const char*, bool> given[] = {{"--cases", !command.group.empty()},
                                                {"--shader-dir", !command.shader_folder.empty()},
                                                {"--json", !command.json.empty()}};
  for (const auto& [name, is] : given)
    if (is) return fail(ErrorKind::usage, fmt::format("{}: goes with --call", name));
  return {};
}

Expected<ExitCode> run_shaders(const ShadersCommand& command) {
  if (!command.function.empty()) return run_call(command);
  if (const auto fine = check_no_call(command); !fine) return fail(fine.error());
  if (command.folder.empty()) {
    print_data(list_of_shaders());
    return ExitCode::done;
  }
  Console console(command.quiet);
  if (const auto writable = check_output_folder(command.folder); !writable) return fail(writable.error());
  if (const auto safe = check_nothing_is_lost(command); !safe) return fail(safe.error());
  if (const auto written = write_shaders(command.folder); !written) return fail(written.error());
  console.message(fmt::format("shaders: {}/{} and {} more", command.folder, named_shader,
                              raster::own_shaders().size() - 1));
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(shaders, 60,
               "List the rasterizer's shaders, write them into a folder to be edited for --shader-dir, or "
               "try a function of one's own.") {
  app->footer(
      "gnomon shaders                  their names and what they are\n"
      "gnomon shaders -o mine          then edit mine/technique/hard.glsl\n"
      "gnomon compare fence --shader-dir mine\n"
      "gnomon shaders --call ray_box --shader-dir mine   is function/ray_box.glsl right?");
  const auto command = std::make_shared<ShadersCommand>();
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for the files; one that was edited there is not overwritten [default: list them]");
  add_name(
      *app, "--call", command->function, "NAME",
      fmt::format("instead call a function of the ray-tracing homework, and say which answers are right [{}]",
                  fmt::join(functions::function_names(), ", ")));
  add_name(*app, "--cases", command->group, "NAME",
           "of --call: all cases of one kind, such as front or behind [default: how many of each are right]");
  add_shader_dir(*app, command->shader_folder);
  add_backend(*app, command->backend);
  add_json(*app, command->json, "the answers of --call");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_shaders(*command); }; });
}

}  // namespace gnomon::app
