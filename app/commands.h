// The commands of the programs. A file of ROOM/commands holds one, which registers itself: that the file is linked is all that
// it takes. Each room's commands are a program, gnomon or gnomon-ROOM, and each program starts the others' by name, as git does.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct Invocation;

/// A command as --help lists it, of this program or of another.
struct Command {
  std::string_view name;
  int place = 0;                                          ///< in --help; the lowest is first
  std::string_view text;                                  ///< what it does
  std::string_view program{};                             ///< that has it; empty: this one
  void (*add_options)(CLI::App*, Invocation&) = nullptr;  ///< none: the command is another program's
};

/// Adds a command to this program; an object of static storage does so before main() begins.
struct Registered {
  explicit Registered(const Command& command);
};

/// Begins the definition of a command. The body that follows binds the options of `app` (not null). Where the command is the one that
/// was named, it sets the invocation's action. cmake/GnomonProgram.cmake reads name, place and text from here, too.
#define GNOMON_COMMAND(name, place, text)                                                 \
  static void add_##name##_options(CLI::App* app, ::gnomon::app::Invocation& invocation); \
  static const ::gnomon::app::Registered name##_is_registered(                            \
      {#name, place, text, {}, add_##name##_options});                                    \
  static void add_##name##_options(CLI::App* app, ::gnomon::app::Invocation& invocation)

/// This program's commands and those of the others, by their place.
std::vector<Command> all_commands();

/// Generated: the commands of all programs that this platform builds, this one's among them.
std::span<const Command> commands_of_programs();

}  // namespace gnomon::app
