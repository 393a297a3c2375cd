// What a parsed command line asks for. Each subcommand has a file of its own in app/commands, whose add_…
// function binds its options and, when it is the one that was named, sets `action`.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

enum class ExitCode : int { done = 0, threshold_exceeded = 1 };

struct Invocation {
  std::string command_line;  ///< as the user could type it again
  /// Run when lessons and scenes have given their settings; throws CLI::ParseError.
  std::function<void()> finish;
  std::function<Expected<ExitCode>()> action;
  int threads = 0;     ///< at most so many of the ray tracer and of the rasterizer; 0: one for each processor
  bool quiet = false;  ///< no messages but errors
  std::vector<std::string> notes;  ///< on what was typed
  std::string trace;               ///< file for the stages of the run; empty: none
  /// Where a scene's file set an option ("--bias"), as errors without a reason.
  std::map<std::string, Error> settings;
};

/// Adds the commands that there are on this platform (app/commands/all.cpp, or the platform's own list).
void add_commands(CLI::App& program, Invocation& invocation);

void add_compare(CLI::App& program, Invocation& invocation);
void add_raster(CLI::App& program, Invocation& invocation);
void add_raytrace(CLI::App& program, Invocation& invocation);
void add_plan(CLI::App& program, Invocation& invocation);
void add_scenes(CLI::App& program, Invocation& invocation);
void add_export(CLI::App& program, Invocation& invocation);
void add_grade(CLI::App& program, Invocation& invocation);
void add_lessons(CLI::App& program, Invocation& invocation);
void add_site(CLI::App& program, Invocation& invocation);
void add_merge(CLI::App& program, Invocation& invocation);
void add_shaders(CLI::App& program, Invocation& invocation);
void add_sweep(CLI::App& program, Invocation& invocation);
void add_tune(CLI::App& program, Invocation& invocation);
void add_bench(CLI::App& program, Invocation& invocation);
void add_verify(CLI::App& program, Invocation& invocation);
void add_serve(CLI::App& program, Invocation& invocation);
void add_view(CLI::App& program, Invocation& invocation);
void add_judge(CLI::App& program, Invocation& invocation);
void add_shimmer(CLI::App& program, Invocation& invocation);

}  // namespace gnomon::app
