// What -h prints: of the program every command in one line, of a command its usual options. What is cut short ends where its first
// part does.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "app/help/manual.h"
#include "raster/settings.h"

namespace gnomon::app {
namespace {

constexpr std::size_t screen_width = 80;   // columns
constexpr std::size_t name_column = 12;    // of what a command does
constexpr std::size_t option_column = 27;  // of what an option does
constexpr std::ptrdiff_t most_lines = 40;
constexpr std::size_t most_examples = 4;

/// The options that most people need, of whatever commands have them; where there is no room for all, the first.
constexpr const char* usual_options[] = {
    "--output",     "--size",     "--technique", "--map-size",   "--bias",    "--slope-bias",
    "--max-error",  "--max-time", "--engine",    "--fail-above", "--scene",   "--visibility",
    "--shadowed",   "--map",      "--shard",     "--light",      "--camera",  "--samples",
    "--json",       "--csv",      "--aov",       "--new",        "--suite",   "--port",
    "--listen",     "--script",   "--precision", "--cascades",   "--heatmap", "--filter-radius",
    "--shader-dir", "--exposure", "--threads",   "--quiet"};

std::ptrdiff_t lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// "constant bias: a receiver is shadowed when ..." is "constant bias"; what is too long still ends at a comma, or at a word.
std::string first_part(std::string_view text, std::size_t most) {
  text = text.substr(0, text.find_first_of(":;"));
  for (const std::string_view end : {" (", " [", ". "}) text = text.substr(0, text.find(end));
  if (text.ends_with('.')) text.remove_suffix(1);
  if (text.size() <= most) return std::string(text);
  const std::string_view fits = text.substr(0, most + 1);
  if (const std::size_t comma = fits.rfind(','); comma != std::string_view::npos && comma > most / 2)
    return std::string(text.substr(0, comma));
  return fmt::format("{} ...", fits.substr(0, fits.rfind(' ', most - 4)));
}

/// Two columns: what is called so, and what it is.
std::string two_columns(const std::string& name, const std::string& text, std::size_t column) {
  const std::string wrapped = wrap(text, column, screen_width);
  return name.size() + 4 > column ? fmt::format("  {}\n{}", name, wrapped)
                                  : fmt::format("  {:<{}}{}", name, column - 2, wrapped.substr(column));
}

/// What a setting of the map does stands in its row; elsewhere which techniques read it stands before that.
std::string option_row(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_lnames().empty())
    if (const raster::MapSetting* setting = raster::find_setting(option.get_lnames().front()))
      text = setting->help;
  text = first_part(text, screen_width - option_column);
  if (const std::vector<std::string> values = named_values(option); values.size() > 1)
    text += fmt::format(" [{}]", fmt::join(values, " or "));
  return two_columns(option_usage(option), text, option_column);
}

/// At most so many lines of the usual options.
std::string option_rows(const CLI::App& command, std::ptrdiff_t room) {
  std::string rows;
  for (const char* name : usual_options) {
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) continue;
    const std::string next = option_row(*option);
    if (lines_of(rows + next) <= room) rows += next;
  }
  return rows;
}

/// An example without what is said behind it, where there is no room for that.
std::string fitting(const std::string& example) {
  return example.size() <= screen_width ? example : example.substr(0, example.find("   ", 2));
}

std::string first_examples(const CLI::App& command) {
  std::string text = "Examples:\n";
  std::istringstream lines(command.get_footer());
  std::size_t count = 0;
  for (std::string line; count < most_examples && std::getline(lines, line);) {
    const std::string example = fitting("  " + line);
    if (example.size() > screen_width) continue;
    text += example + "\n";
    ++count;
  }
  return text;
}

/// All of the help, where that is short enough.
std::string whole_help(const CLI::App& command) {
  std::string text;
  std::istringstream lines(help_text(command));
  for (std::string line; std::getline(lines, line);)
    text += (line.starts_with("  gnomon ") ? fitting(line) : line) + "\n";
  return text;
}

std::string short_program_help(const CLI::App& program) {
  std::string commands;
  for (const CLI::App* command : program.get_subcommands({}))
    commands += two_columns(command->get_name(),
                            first_part(command->get_description(), screen_width - name_column), name_column);
  return fmt::format(
      "{}\nUsage: gnomon COMMAND [OPTIONS]\n\n{}\nCommands:\n{}\n"
      "gnomon COMMAND -h says more of a command, gnomon help all that there is.\n",
      wrap(program.get_description(), 0, screen_width), first_examples(program), commands);
}

std::string short_command_help(const CLI::App& command) {
  std::string text =
      fmt::format("{}\n{}\nUsage: {} [OPTIONS]\n", wrap(command.get_description(), 0, screen_width),
                  first_examples(command), usage_of(command));
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += two_columns(option_usage(*option), option->get_description(), option_column);
  const std::string more = fmt::format("\ngnomon {} --help has all {} options.\n", command.get_name(),
                                       command.get_options().size());
  text += "\nOptions that are often needed:\n";
  return text + option_rows(command, most_lines - lines_of(text + more)) + more;
}

}  // namespace

std::string short_help_text(const CLI::App& command) {
  if (command.get_parent() == nullptr) return short_program_help(command);
  const std::string all = whole_help(command);
  return lines_of(all) <= most_lines ? all : short_command_help(command);
}

}  // namespace gnomon::app
