// The chapters of docs/manual/ that the program writes of itself, so that they cannot drift from it: the
// options from the parser, the keys of result.json from its schema, the techniques from their table.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace gnomon::app {

/// "options", "json" or "techniques", as Markdown; empty for any other chapter.
std::string manual_chapter(const CLI::App& program, std::string_view chapter);

}  // namespace gnomon::app
