#include "app/commands.h"

#include <algorithm>

namespace gnomon::app {

namespace {

std::vector<Command>& registered() {
  static std::vector<Command> commands;
  return commands;
}

}  // namespace

Registered::Registered(const Command& command) {
  registered().push_back(command);
}

std::vector<Command> all_commands() {
  std::vector<Command> commands = registered();
  for (const Command& command : commands_of_programs())
    if (std::none_of(commands.begin(), commands.end(),
                     [&](const Command& own) { return own.name == command.name; }))
      commands.push_back(command);
  std::sort(commands.begin(), commands.end(),
            [](const Command& a, const Command& b) { return a.place < b.place; });
  return commands;
}

}  // namespace gnomon::app
