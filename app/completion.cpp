#include "app/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "compare/report/lessons.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands({});
}

/// What an option is for, without its unit, range and default; quotes would end the shells' own.
std::string purpose(const CLI::Option& option) {
  std::string text = option.get_description();
  text = text.substr(0, text.find(" ["));
  std::erase_if(text, [](char c) { return c == '\'' || c == '"' || c == '`' || c == '$'; });
  return text;
}

bool takes_value(const CLI::Option& option) {
  return !option.get_type_name().empty();
}

/// "--size --map-size …": every long name.
std::string option_names(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " --") + name;
  }
  return names;
}

std::string command_names(const CLI::App& program) {
  std::string names;
  for (const CLI::App* command : commands_of(program))
    names += (names.empty() ? "" : " ") + command->get_name();
  return names;
}

std::string scene_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes())
    names += (names.empty() ? "" : " ") + std::string(scene.name);
  for (const compare::Lesson& lesson : compare::all_lessons()) names += " " + std::string(lesson.name);
  return names;
}

std::string bash_script(const CLI::App& program) {
  std::string cases;
  for (const CLI::App* command : commands_of(program)) {
    cases += fmt::format("    {}) words=\"{} {}\" ;;\n", command->get_name(), option_names(*command),
                         scene_names());
  }
  return fmt::format(
      "_gnomon() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words=\"{} {}\"\n"
      "  ((COMP_CWORD > 1)) && case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\"; ((COMP_CWORD > 1)) && compgen -f -- "
      "\"$word\")\n"
      "}}\n"
      "complete -o filenames -F _gnomon gnomon\n",
      command_names(program), option_names(program), cases);
}

std::string zsh_script(const CLI::App& program) {
  std::string commands, cases;
  for (const CLI::App* command : commands_of(program)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), command->get_description());
    cases += fmt::format("    {})\n      _arguments '*:scene:_gnomon_scenes'", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        cases += fmt::format(" \\\n        '--{}[{}]{}'", name, purpose(*option),
                             takes_value(*option) ? ":" + name + ":_files" : "");
      }
    }
    cases += " ;;\n";
  }
  return fmt::format(
      "#compdef gnomon\n"
      "_gnomon_scenes() {{ compadd {}; _files }}\n"
      "_gnomon() {{\n  local -a commands=(\n{}  )\n"
      "  if ((CURRENT == 2)); then _describe command commands; return; fi\n"
      "  local command=$words[2]\n  shift words; ((CURRENT--))\n"
      "  case $command in\n{}  esac\n}}\n"
      "_gnomon \"$@\"\n",
      scene_names(), commands, cases);
}

std::string fish_script(const CLI::App& program) {
  std::string text = "complete -c gnomon -n __fish_use_subcommand -f\n";
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format("complete -c gnomon -n __fish_use_subcommand -a {} -d '{}'\n", command->get_name(),
                        command->get_description());
    const std::string condition = fmt::format("-n '__fish_seen_subcommand_from {}'", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c gnomon {} -l {}{} -d '{}'\n", condition, name,
                            takes_value(*option) ? " -r" : "", purpose(*option));
      }
    }
    text += fmt::format("complete -c gnomon {} -a '{}'\n", condition, scene_names());
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& program, std::string_view shell) {
  if (shell == "bash") return bash_script(program);
  if (shell == "zsh") return zsh_script(program);
  if (shell == "fish") return fish_script(program);
  return {};
}

}  // namespace gnomon::app
