#include "app/help/manual.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <sstream>

namespace gnomon::app {

namespace {

constexpr std::size_t help_width = 80;      // columns
constexpr std::size_t text_indent = 6;      // columns before an option's description
constexpr std::size_t command_column = 12;  // columns of a subcommand's name

std::string examples(const CLI::App& command) {
  std::string text = "Examples:\n";
  std::istringstream lines(command.get_footer());
  for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
  return text;
}

std::string option_help(const CLI::Option& option) {
  return fmt::format("  {}\n{}", option_usage(option),
                     wrap(option.get_description(), text_indent, help_width));
}

/// "SCENE", "[SCENE]", "[CAPTURE...]".
std::string usage_word(const CLI::Option& positional) {
  const std::string name = positional.get_name(true) + (positional.get_items_expected_max() > 1 ? "..." : "");
  return positional.get_required() ? name : "[" + name + "]";
}

std::string command_help(const CLI::App& command) {
  std::string positionals, options;
  for (const CLI::Option* option : command.get_options())
    (option->get_positional() ? positionals : options) += option_help(*option);
  return fmt::format("{}\n{}\nUsage: {} [OPTIONS]\n{}{}\nOptions:\n{}",
                     wrap(command.get_description(), 0, help_width), examples(command), usage_of(command),
                     positionals.empty() ? "" : "\n", positionals, options);
}

std::string program_help(const CLI::App& program) {
  std::string commands, options;
  for (const CLI::App* command : program.get_subcommands({})) {
    const std::string text = wrap(command->get_description(), 2 + command_column, help_width);
    commands +=
        fmt::format("  {:<{}}{}", command->get_name(), command_column, text.substr(2 + command_column));
  }
  for (const CLI::Option* option : program.get_options()) options += option_help(*option);
  return fmt::format(
      "{}\n{}\nUsage: gnomon COMMAND [OPTIONS]\n\nCommands (gnomon COMMAND --help says "
      "more):\n{}\nOptions:\n{}",
      wrap(program.get_description(), 0, help_width), examples(program), commands, options);
}

}  // namespace

std::string option_usage(const CLI::Option& option) {
  std::string names = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  for (std::size_t comma = names.find(','); comma != std::string::npos; comma = names.find(',', comma + 2))
    names.replace(comma, 1, ", ");
  const bool takes_value = !option.get_positional() && !option.get_type_name().empty();
  return takes_value ? names + " " + option.get_type_name() : names;
}

std::string usage_of(const CLI::App& command) {
  std::string usage = "gnomon " + command.get_name();
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) usage += " " + usage_word(*option);
  return usage;
}

std::string help_text(const CLI::App& command) {
  return command.get_parent() == nullptr ? program_help(command) : command_help(command);
}

std::string wrap(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string out, line(indent, ' ');
  for (std::string word; words >> word;) {
    const bool first = line.size() == indent;
    if (!first && line.size() + 1 + word.size() > width) {
      out += line + "\n";
      line.assign(indent, ' ');
    } else if (!first) {
      line += ' ';
    }
    line += word;
  }
  return out + line + "\n";
}

}  // namespace gnomon::app
