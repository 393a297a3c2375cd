// What a parsed command line asks for. The command that was named sets `action` (app/commands.h).
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/base/expected.h"

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

}  // namespace gnomon::app
