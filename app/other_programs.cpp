#include "app/other_programs.h"

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "app/commands.h"
#include "app/help/manual.h"
#include "scene/base/run_program.h"
#include "scene/files/own_program.h"

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

/// `what`: "judge is a command of gnomon-judge".
tl::unexpected<Error> not_there(std::string_view what) {
  return fail(ErrorKind::graphics, fmt::format("{}, which is not beside this program; it comes with Gnomon's "
                                               "package, or by ./gnomon build in its sources",
                                               what));
}

}  // namespace

void become_program_of_command(int argc, char** argv) {
  if (argc < 2) return;
  const Command* command = command_elsewhere(argv[argc > 2 && asks_for_help(argv[1]) ? 2 : 1]);
  if (command == nullptr) return;
  execv(program_beside(command->program).c_str(), argv);
}

Expected<void> missing_program(const std::string& command) {
  const Command* elsewhere = command_elsewhere(command);
  if (elsewhere == nullptr) return {};
  return not_there(fmt::format("{} is a command of {}", command, elsewhere->program));
}

std::string description_of(const CLI::App& program) {
  Json commands = Json::object();
  for (const CLI::App* command : program.get_subcommands({})) {
    if (command_elsewhere(command->get_name()) != nullptr) continue;
    Json options = Json::array();
    for (const CLI::Option* option : command->get_options()) options.push_back(option_json(*option));
    commands[command->get_name()] = {{"examples", command->get_footer()}, {"options", std::move(options)}};
  }
  return commands.dump() + "\n";
}

Expected<void> describe_others(CLI::App& program) {
  std::set<std::string_view> others;
  for (const Command& command : all_commands())
    if (!command.add_options) others.insert(command.program);
  for (const std::string_view other : others) {
    const auto end = run_and_listen({program_beside(other), "--describe"});
    const Json described = end && end->code == 0 ? Json::parse(end->said, nullptr, false) : Json();
    if (!described.is_object()) return not_there(fmt::format("some commands are described by {}", other));
    add_description(program, described);
  }
  return {};
}

}  // namespace gnomon::app
