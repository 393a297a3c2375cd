// Runs a program on what a stranger wrote, in a process of its own, with limits on processor time and memory. So
// nothing there can hang or crash the caller. Nothing else that happens on the machine decides how it ends.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grade/rubric.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

struct Outcome {
  enum class End : std::uint8_t {
    exited,
    out_of_time,  ///< it took more processor time than it may
    killed,       ///< by a signal
    stalled       ///< it took none for so long that it was given up: that is no fault of what it drew
  };
  End end = End::exited;
  int code = 0;     ///< exit code, or the signal's number
  std::string err;  ///< what it said on stderr, its first 64 KiB
};

/// Runs the program with these words. It has no stdin, its stdout is thrown away, and it dies with the caller. The time of all
/// its threads counts. `variable`, "NAME=VALUE", stands in its environment besides the caller's own.
/// Error (resources): the process cannot be started.
Expected<Outcome> run_limited(const std::string& program, const std::vector<std::string>& words,
                              const Limits& limits, const std::string& variable = {});

}  // namespace gnomon::grade
