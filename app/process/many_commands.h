// Carries out the commands that another program sends (scene/base/many_commands.h).
#pragma once

namespace gnomon::app {

/// Calls `run` with each command until stdin ends. Returns the process's own exit code.
int run_commands_from_stdin(int (*run)(int argc, const char* const* argv));

}  // namespace gnomon::app
