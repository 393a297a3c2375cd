// The programs beside this one: `gnomon judge` becomes gnomon-judge, and what is printed of all commands (completion, the manual)
// is asked of each program.
#pragma once

#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Becomes the program that has the command argv[1], or that of "help COMMAND", where that is not this one. Returns where it is
/// this one, and where the other cannot be started: missing_program() says so then. Error (graphics): this one was started for another
/// of the programs, as which it lies there, or by one of another version.
Expected<void> become_program_of_command(int argc, char** argv);

/// Error (graphics) that names the program of a command which this one has not; none for any other word.
Expected<void> missing_program(const std::string& command);

/// The options of this program's commands as JSON, for describe_others() of another.
std::string description_of(const CLI::App& program);

/// Gives the commands of other programs their options, as those describe them. Returns an error (graphics) for each program that is
/// not there, or is another. Error (graphics): one that is there cannot be asked.
Expected<std::vector<Error>> describe_others(CLI::App& program);

}  // namespace gnomon::app
