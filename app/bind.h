// What every command does with its options once they are bound.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "app/effect_options.h"
#include "app/invocation.h"
#include "app/map_options.h"

namespace gnomon::app {

/// When the command is the one that was named: `finish` completes its map's options where it has a setting, `given`
/// learns what was typed and `trace` the file of the stages where it asks for that, and the action is `run`.
template <class Command, class Run>
void bind_run(CLI::App& app, Invocation& invocation, const std::shared_ptr<Command>& command, Run run) {
  app.callback([&, command, run] {  // not every command uses app
    if constexpr (requires { command->setting.options.raster.map; })
      invocation.finish = [&app, command] { finish_map_options(app, command->setting.options.raster.map); };
    if constexpr (requires { command->trace; }) command->trace = invocation.trace;
    if constexpr (requires { command->given; }) command->given = given_options(app);
    invocation.action = [command, run] { return run(*command); };
  });
}

}  // namespace gnomon::app
