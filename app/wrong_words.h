// What is said of words that the program does not know, with what was probably meant. That is a slip of the fingers, another
// program's name for an option, or an option of another command.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace gnomon::app {

/// Another program's name for an option of this one, both without dashes.
struct OptionSynonym {
  std::string_view theirs;
  std::string_view ours;
};
std::span<const OptionSynonym> option_synonyms();

/// Of a first word that is neither a command nor an option.
std::string unknown_command_text(const CLI::App& program, const std::string& word);

/// Of a command line that CLI11 refuses. A command's name stands before what is said of its options.
std::string parse_failure_text(const CLI::App& program, const CLI::ParseError& error);

}  // namespace gnomon::app
