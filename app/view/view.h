// The interactive window: where its options and its entry point live. Command and window come with view.cpp.
#pragma once

#include <string>

#include "compare/compare.h"

namespace gnomon::app {

struct ViewOptions {
  std::string scene;  ///< a path or the name of a built-in scene
  compare::CompareOptions compare;
  std::string
      script;  ///< a file of `set`, `wait`, `screenshot` and `quit` lines that drives the window; empty: none
};

/// Opens the window and returns the process's exit code when it is closed.
int run_view(const ViewOptions& options);

}  // namespace gnomon::app
