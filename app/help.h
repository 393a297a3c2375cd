// The text of --help: examples first, then every option with its unit, range and default, at most 80 columns
// wide.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace gnomon::app {

/// Of the program itself (no parent) or of one subcommand. A command's examples are its footer, one per line.
std::string help_text(const CLI::App& command);

/// `text` broken at blanks so that no line passes `width` columns; every line starts with `indent` blanks.
std::string wrap(const std::string& text, std::size_t indent, std::size_t width);

}  // namespace gnomon::app
