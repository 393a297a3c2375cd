// Shell completion, made from the parser itself so that it cannot drift from it.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace gnomon::app {

/// The script for "bash", "zsh" or "fish"; empty for any other shell.
std::string completion_script(const CLI::App& program, std::string_view shell);

}  // namespace gnomon::app
