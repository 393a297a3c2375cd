// The text of --help, the manual page, the completion of shells, and chapters of the manual are made from the parser itself. So they cannot drift from it. The keys of result.json come from its schema, the techniques from their table.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gnomon::app {

/// A word in the place of a command that asks for what an option of the program does.
struct WordForOption {
  std::string_view word, option;
};
inline constexpr std::array<WordForOption, 2> words_for_options{
    {{"help", "--help"}, {"version", "--version"}}};
/// The option that the word stands for, or the word itself.
constexpr std::string_view option_for(std::string_view word) {
  for (const WordForOption& each : words_for_options)
    if (each.word == word) return each.option;
  return word;
}
/// Whether the first word of a command line asks for the help on the second.
constexpr bool asks_for_help(std::string_view word) {
  return word == "-h" || option_for(word) == "--help";
}

/// "-o, --output DIR", or "SCENE".
std::string option_usage(const CLI::Option& option);
/// "gnomon merge SHARD...", without options.
std::string usage_of(const CLI::App& command);

/// Examples first, then every option with its unit, range and default, at most 80 columns wide. Of the program itself (no parent) or of one subcommand. A command's examples are its footer, one per line.
std::string help_text(const CLI::App& command);
/// What most people need of it, at most 40 lines: each command, or each of the command's usual options, in one line or two.
std::string short_help_text(const CLI::App& command);

/// `text` broken at blanks so that no line passes `width` columns; every line starts with `indent` blanks.
std::string wrap(const std::string& text, std::size_t indent, std::size_t width);

/// gnomon(1) in the man macros of roff (man 7).
std::string man_page(const CLI::App& program, const std::string& version);

/// The values of an option that its help names: "hard", "pcf" of "shadow test [hard or pcf; default hard]", "auto" of "auto|FACTOR".
std::vector<std::string> named_values(const CLI::Option& option);

/// The script for "bash", "zsh" or "fish"; empty for any other shell.
std::string completion_script(const CLI::App& program, std::string_view shell);

/// The chapters that are pages of the manual beside those of docs/manual/.
inline constexpr std::array<std::string_view, 3> written_chapters{"options", "json", "techniques"};
/// One of these as Markdown, or "schema" as JSON; empty for any other chapter.
std::string manual_chapter(const CLI::App& program, std::string_view chapter);

}  // namespace gnomon::app
