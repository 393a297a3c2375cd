// Runs the program itself on what a stranger wrote: in a process of its own, with limits on time and memory,
// so that nothing there can hang or crash the caller.
#pragma once

#include <string>
#include <vector>

#include "app/grade/rubric.h"
#include "scene/expected.h"

namespace gnomon::app::grade {

struct Outcome {
  enum class End : std::uint8_t { exited, timed_out, killed } end = End::exited;
  int code = 0;     ///< exit code, or the signal's number
  std::string err;  ///< what it said on stderr, its first 64 KiB
};

/// This program with these words. It has no stdin, its stdout is thrown away, and it dies with the caller.
/// Error (resources): the process cannot be started.
Expected<Outcome> run_limited(const std::vector<std::string>& words, const Limits& limits);

}  // namespace gnomon::app::grade
