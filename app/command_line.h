// From argv to an exit code (the codes are those of ErrorKind and ExitCode).
#pragma once

namespace gnomon::app {

/// Parses and runs. Every failure is one line on stderr.
int run_command_line(int argc, const char* const* argv);

/// Parses only, and runs nothing: 0, or 2 with the line on stderr. For the commands that the documents show.
int check_command_line(int argc, const char* const* argv);

}  // namespace gnomon::app
