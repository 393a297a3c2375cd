#include "app/other_programs.h"

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "app/commands.h"
#include "app/help/manual.h"
#include "compare/result/option_names.h"
#include "scene/base/run_program.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"

namespace gnomon::app {

namespace {

using Json = nlohmann::ordered_json;

/// Null: this program has it, or none.
const Command* command_elsewhere(std::string_view name) {
  static const std::vector<Command> commands = all_commands();
  const auto found = std::find_if(commands.begin(), commands.end(), [&](const Command& command) {
    return command.name == name && !command.add_options;
  });
  return found == commands.end() ? nullptr : &*found;
}

Json option_json(const CLI::Option& option) {
  return {{"names", option.get_name(true, true)},
          {"text", option.get_description()},
          {"type", option.get_type_name()},
          {"required", option.get_required()},
          {"most", option.get_items_expected_max()}};
}

void add_described_option(CLI::App& command, const Json& described) {
  const std::string text = described.at("text");
  command.add_option(described.at("names").get<std::string>(), text)
      ->type_name(described.at("type").get<std::string>())
      ->required(described.at("required").get<bool>())
      ->expected(0, described.at("most").get<int>());
}

/// Of a program that describes its commands.
void add_description(CLI::App& program, const Json& commands) {
  for (const auto& [name, described] : commands.items()) {
    CLI::App* command = program.get_subcommand(name);
    command->footer(described.at("examples").get<std::string>());
    for (const Json& option : described.at("options"))
      if (option.at("names") != command->get_help_ptr()->get_name(true, true))
        add_described_option(*command, option);
  }
}

/// How the program that starts another says who it is: "PID PROGRAM VERSION", the program being the one that it starts.
constexpr const char* started_by = "GNOMON_STARTED_BY";

struct Starter {
  pid_t process = 0;
  std::string program;
  std::string version;
};

/// What started this process by name, if one of the programs did. Who is started by this one is not told of it.
std::optional<Starter> take_starter() {
  const char* text = std::getenv(started_by);
  if (text == nullptr) return std::nullopt;
  std::istringstream words(text);
  unsetenv(started_by);
  Starter starter;
  if (!(words >> starter.process >> starter.program >> starter.version)) return std::nullopt;
  return starter;
}

/// A build of sources that were changed is one of their commit.
bool is_same_version(std::string_view a, std::string_view b) {
  constexpr std::string_view changed = ".changed";
  for (std::string_view* version : {&a, &b})
    if (version->ends_with(changed)) version->remove_suffix(changed.size());
  return a == b;
}

constexpr std::string_view where_programs_are =
    "Gnomon's package, or ./gnomon build in its sources, brings all its programs";

/// "gnomon-judge is of version 0.1.0, and this program of 0.2.0; ..."
std::string other_version(std::string_view program, std::string_view version, std::string_view other,
                          std::string_view others) {
  return fmt::format("{} is of version {}, and {} of {}; {}", program, version, other, others,
                     where_programs_are);
}

bool may_be_started(const std::string& path) {
  return file_kind_or_none(path) == FileKind::file && access(path.c_str(), X_OK) == 0;
}

/// Why the program cannot be started, as the end of a sentence that begins with its name.
std::string why_not_started(std::string_view program) {
  const std::string path = program_beside(program);
  const FileKind kind = file_kind_or_none(path);
  if (kind == FileKind::none) return fmt::format("which is not beside this program; {}", where_programs_are);
  if (kind != FileKind::file) return fmt::format("and {} is no file; {}", path, where_programs_are);
  if (access(path.c_str(), X_OK) != 0)
    return fmt::format("and {0} may not be executed; chmod +x {0} lets it", path);
  return fmt::format("and {} is not that program; {}", path, where_programs_are);
}

/// What the program says of its commands; null where it is not there. Error: it is there, and cannot be asked.
Expected<Json> description_by(std::string_view program) {
  const std::string path = program_beside(program);
  if (!may_be_started(path)) return Json();
  const auto end = run_and_listen({path, "--describe"});
  if (!end) return fail(end.error());
  if (end->code == 0) return Json::parse(end->said, nullptr, false);
  return fail(ErrorKind::graphics, fmt::format("{} does not say what its commands are (exit code {}); {}",
                                               path, end->code, where_programs_are));
}

/// Why what a program says of its commands is of no use; empty where it is.
std::string description_defect(std::string_view program, const Json& described) {
  if (!described.is_object())
    return fmt::format("some commands are those of {}, {}", program, why_not_started(program));
  const std::string version = described.value("version", std::string());
  if (!is_same_version(version, compare::program_version()))
    return other_version(program, version, "this program", compare::program_version());
  for (const Command& command : all_commands())
    if (command.program == program && !described.at("commands").contains(command.name))
      return fmt::format("{} is a command of {}, {}", command.name, program, why_not_started(program));
  return {};
}

}  // namespace

Expected<void> become_program_of_command(int argc, char** argv) {
  const std::optional<Starter> starter = take_starter();
  const bool became_this = starter && starter->process == getpid();
  if (became_this && !is_same_version(starter->version, compare::program_version()))
    return fail(ErrorKind::graphics, other_version(starter->program, compare::program_version(),
                                                   "what started it", starter->version));
  if (argc < 2) return {};
  const Command* command = command_elsewhere(argv[argc > 2 && asks_for_help(argv[1]) ? 2 : 1]);
  if (command == nullptr) return {};
  if (starter && starter->program == command->program) return missing_program(std::string(command->name));
  setenv(started_by, fmt::format("{} {} {}", getpid(), command->program, compare::program_version()).c_str(),
         1);
  execv(program_beside(command->program).c_str(), argv);
  unsetenv(started_by);
  return {};
}

Expected<void> missing_program(const std::string& command) {
  const Command* elsewhere = command_elsewhere(command);
  if (elsewhere == nullptr) return {};
  return fail(ErrorKind::graphics, fmt::format("{} is a command of {}, {}", command, elsewhere->program,
                                               why_not_started(elsewhere->program)));
}

std::string description_of(const CLI::App& program) {
  Json commands = Json::object();
  for (const CLI::App* command : program.get_subcommands({})) {
    if (command_elsewhere(command->get_name()) != nullptr) continue;
    Json options = Json::array();
    for (const CLI::Option* option : command->get_options()) options.push_back(option_json(*option));
    commands[command->get_name()] = {{"examples", command->get_footer()}, {"options", std::move(options)}};
  }
  return Json{{"version", compare::program_version()}, {"commands", std::move(commands)}}.dump() + "\n";
}

Expected<std::vector<Error>> describe_others(CLI::App& program) {
  std::set<std::string_view> others;
  for (const Command& command : all_commands())
    if (!command.add_options) others.insert(command.program);
  std::vector<Error> missing;
  for (const std::string_view other : others) {
    const auto described = description_by(other);
    if (!described) return fail(described.error());
    const std::string defect = description_defect(other, *described);
    if (defect.empty())
      add_description(program, described->at("commands"));
    else
      missing.push_back({ErrorKind::graphics, defect});
  }
  return missing;
}

}  // namespace gnomon::app
