// The manual page, made from the parser itself so that it cannot drift from it.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace gnomon::app {

/// gnomon(1) in the man macros of roff (man 7).
std::string man_page(const CLI::App& program, const std::string& version);

}  // namespace gnomon::app
