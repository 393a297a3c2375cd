// The text of --help, the manual page, the completion of shells, and chapters of the manual are made from the parser itself. So they cannot drift from it. The keys of result.json come from its schema, the techniques from their table.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace gnomon::app {

/// Examples first, then every option with its unit, range and default, at most 80 columns wide. Of the program itself (no parent) or of one subcommand. A command's examples are its footer, one per line.
std::string help_text(const CLI::App& command);

/// `text` broken at blanks so that no line passes `width` columns; every line starts with `indent` blanks.
std::string wrap(const std::string& text, std::size_t indent, std::size_t width);

/// gnomon(1) in the man macros of roff (man 7).
std::string man_page(const CLI::App& program, const std::string& version);

/// The script for "bash", "zsh" or "fish"; empty for any other shell.
std::string completion_script(const CLI::App& program, std::string_view shell);

/// The chapters that are pages of the manual beside those of docs/manual/.
inline constexpr std::array<std::string_view, 3> written_chapters{"options", "json", "techniques"};
/// One of these as Markdown, or "schema" as JSON; empty for any other chapter.
std::string manual_chapter(const CLI::App& program, std::string_view chapter);

}  // namespace gnomon::app
