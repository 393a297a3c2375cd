#include "app/help/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "report/lessons.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands({});
}

/// Quotes would end the shells' own.
std::string quoted_text(std::string text) {
  std::erase_if(text, [](char c) { return c == '\'' || c == '"' || c == '`' || c == '$'; });
  return text;
}

/// What an option is for, without its unit, range and default.
std::string purpose(const CLI::Option& option) {
  const std::string text = option.get_description();
  return quoted_text(text.substr(0, text.find(" [")));
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

std::string words_of_commands(const CLI::App& program) {
  std::string names;
  for (const CLI::App* command : commands_of(program))
    names += (names.empty() ? "" : " ") + command->get_name();
  return names;
}

/// What may stand in a command's place: "compare raster … help version".
std::string first_words(const CLI::App& program) {
  std::string words = words_of_commands(program);
  for (const WordForOption& each : words_for_options) words += fmt::format(" {}", each.word);
  return words;
}

std::string scene_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes())
    names += (names.empty() ? "" : " ") + std::string(scene.name);
  for (const report::Lesson& lesson : report::all_lessons()) names += " " + std::string(lesson.name);
  return names;
}

bool takes_scene(const CLI::App& command) {
  return command.get_option_no_throw("SCENE") != nullptr;
}

/// What may follow an option.
struct OptionChoices {
  std::vector<std::string> words;  ///< "hard", "pcf" …
  bool files = false;
};

bool is_word(const std::string& text) {
  return !text.empty() && text.find_first_of(" <>()'\"") == std::string::npos;
}

/// From the help itself, "what [hard or pcf or vsm; default hard]", and the value's type, "off|on" or "FILE".
OptionChoices values_of(const CLI::Option& option) {
  OptionChoices values;
  const std::string type = option.get_type_name();
  for (const char* name : {"FILE", "DIR", "IMAGE"}) values.files = values.files || type.starts_with(name);
  if (type == "off|on") values.words = {"off", "on"};
  const std::string text = option.get_description();
  const std::size_t open = text.rfind(" [");
  if (type.empty() || !values.words.empty() || open == std::string::npos) return values;
  std::string range = text.substr(open + 2);
  range = range.substr(0, range.find_first_of(";]"));
  std::vector<std::string> words;
  for (std::size_t end = 0; end != std::string::npos;
       range.erase(0, end == std::string::npos ? end : end + 4)) {
    end = range.find(" or ");
    words.push_back(range.substr(0, end));
  }
  if (words.size() > 1 && std::all_of(words.begin(), words.end(), is_word)) values.words = std::move(words);
  return values;
}

/// Lists of values have commas between them: "NAME,…", "NAME[,NAME]".
bool takes_list(const CLI::Option& option) {
  return option.get_type_name().find(',') != std::string::npos;
}

/// Makes bash's cases of all commands: "compare --technique"|"raster --technique") values="hard pcf" ;;
std::string bash_values(const CLI::App& program) {
  std::map<std::string, std::string> patterns;  // by what is offered
  std::vector<const CLI::App*> takers = commands_of(program);
  takers.push_back(&program);
  for (const CLI::App* taker : takers) {
    for (const CLI::Option* option : taker->get_options()) {
      if (!takes_value(*option) || option->get_positional()) continue;
      const OptionChoices values = values_of(*option);
      const std::string offer =
          values.files ? "files=1" : fmt::format("files= values=\"{}\"", fmt::join(values.words, " "));
      std::vector<std::string> names = option->get_lnames();
      for (std::string& name : names) name = "--" + name;
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      for (const std::string& name : names) {
        std::string& pattern = patterns[offer];
        // An option of the program itself is the first word, in the command's place.
        pattern += fmt::format("{}\"{} {}\"", pattern.empty() ? "" : "|",
                               taker == &program ? name : taker->get_name(), name);
      }
    }
  }
  std::string cases;
  for (const auto& [offer, pattern] : patterns)
    cases += fmt::format("    {}) {}; is_value=1 ;;\n", pattern, offer);
  return cases;
}

std::string bash_script(const CLI::App& program) {
  std::string cases = fmt::format("    help) words=\"{}\" files= ;;\n", words_of_commands(program));
  for (const CLI::App* command : commands_of(program)) {
    cases += fmt::format("    {}) words=\"{} {}\" ;;\n", command->get_name(), option_names(*command),
                         takes_scene(*command) ? scene_names() : "");
  }
  // bash splits "--technique=pcf" into three words. Of a list, "hard,pcf", the last part is completed.
  return fmt::format(
      "_gnomon() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words=\"{} {}\" option= values= files=1 is_value=\n"
      "  ((COMP_CWORD > 0)) && option=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  [[ $option == = ]] && option=${{COMP_WORDS[COMP_CWORD - 2]}}\n"
      "  [[ $word == = ]] && option=${{COMP_WORDS[COMP_CWORD - 1]}} word=\n"
      "  ((COMP_CWORD > 1)) && case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  ((COMP_CWORD > 1)) || files=\n"
      "  case \"${{COMP_WORDS[1]}} $option\" in\n{}  esac\n"
      "  [[ $is_value ]] && words=$values\n"
      "  local last=${{word##*,}} begin=\n"
      "  [[ $is_value && $values ]] && begin=${{word%\"$last\"}} || last=$word\n"
      "  mapfile -t COMPREPLY < <(compgen -P \"$begin\" -W \"$words\" -- \"$last\"; [[ $files ]] && compgen "
      "-f -- \"$word\")\n"
      "}}\n"
      "complete -o filenames -F _gnomon gnomon\n",
      first_words(program), option_names(program), cases, bash_values(program));
}

std::string zsh_action(const CLI::Option& option) {
  const OptionChoices values = values_of(option);
  if (values.files) return "_files";
  if (values.words.empty()) return " ";
  const std::string words = fmt::format("{}", fmt::join(values.words, " "));
  return takes_list(option) ? "_sequence compadd - " + words : "(" + words + ")";
}

std::string zsh_script(const CLI::App& program) {
  std::string commands, cases = "    help) _describe command commands ;;\n";
  for (const WordForOption& each : words_for_options)
    commands +=
        fmt::format("    '{}:{}'\n", each.word, purpose(*program.get_option(std::string(each.option))));
  for (const CLI::App* command : commands_of(program)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), quoted_text(command->get_description()));
    cases += fmt::format("    {})\n      _arguments '{}'", command->get_name(),
                         takes_scene(*command) ? "*:scene:_gnomon_scenes" : "*:file:_files");
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        cases += fmt::format(" \\\n        '--{}[{}]{}'", name, purpose(*option),
                             takes_value(*option) ? ":" + name + ":" + zsh_action(*option) : "");
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

std::string fish_argument(const CLI::Option& option) {
  if (!takes_value(option)) return {};
  const OptionChoices values = values_of(option);
  if (values.files) return " -r -F";
  if (values.words.empty()) return " -x";
  const std::string words = fmt::format("{}", fmt::join(values.words, takes_list(option) ? "," : " "));
  return takes_list(option) ? fmt::format(" -x -a '(__fish_append , (string split , \"{}\"))'", words)
                            : fmt::format(" -x -a '{}'", words);
}

std::string fish_script(const CLI::App& program) {
  std::string text = "complete -c gnomon -n __fish_use_subcommand -f\n";
  for (const WordForOption& each : words_for_options)
    text += fmt::format("complete -c gnomon -n __fish_use_subcommand -a {} -d '{}'\n", each.word,
                        purpose(*program.get_option(std::string(each.option))));
  text += fmt::format("complete -c gnomon -n '__fish_seen_subcommand_from help' -f -a '{}'\n",
                      words_of_commands(program));
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format("complete -c gnomon -n __fish_use_subcommand -a {} -d '{}'\n", command->get_name(),
                        quoted_text(command->get_description()));
    const std::string condition = fmt::format("-n '__fish_seen_subcommand_from {}'", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c gnomon {} -l {}{} -d '{}'\n", condition, name,
                            fish_argument(*option), purpose(*option));
      }
    }
    if (takes_scene(*command))
      text += fmt::format("complete -c gnomon {} -a '{}'\n", condition, scene_names());
  }
  return text;
}

}  // namespace

std::vector<std::string> named_values(const CLI::Option& option) {
  const OptionChoices values = values_of(option);
  std::vector<std::string> names = values.words;
  std::istringstream parts(values.files ? std::string() : option.get_type_name());
  for (std::string part; std::getline(parts, part, '|');)
    if (!part.empty() && std::all_of(part.begin(), part.end(), [](char c) { return c >= 'a' && c <= 'z'; }))
      names.push_back(part);
  return names;
}

std::string completion_script(const CLI::App& program, std::string_view shell) {
  if (shell == "bash") return bash_script(program);
  if (shell == "zsh") return zsh_script(program);
  if (shell == "fish") return fish_script(program);
  return {};
}

}  // namespace gnomon::app
