// Runs a program on what a stranger wrote, in another process, with limits on processor time and memory. So nothing there
// can hang or crash the caller. Nothing else that happens on the machine decides how it ends.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "grade/rubric.h"
#include "scene/base/expected.h"

namespace gnomon {
class Descriptor;
}

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

/// Runs the program with these words. It has no stdin, its stdout is thrown away, and it dies with the calling thread. The
/// time of all its threads counts. `variable`, "NAME=VALUE", stands in its environment besides the caller's own.
/// Error (resources): the process cannot be started.
Expected<Outcome> run_limited(const std::string& program, const std::vector<std::string>& words,
                              const Limits& limits, const std::string& variable = {});

/// Commands that one process carries out after another (scene/base/many_commands.h). Of one that fails, or that the limits
/// end, nothing reaches the next: that has a new process.
class CommandProcess {
 public:
  /// `first`: the words that make the program take commands.
  CommandProcess(std::string program, std::vector<std::string> first, const Limits& limits);
  ~CommandProcess();
  CommandProcess(const CommandProcess&) = delete;
  CommandProcess& operator=(const CommandProcess&) = delete;

  /// As run_limited() with these words, none of them empty; the limit on time is each command's. The process dies with the
  /// thread that called this first.
  Expected<Outcome> run(const std::vector<std::string>& words);

 private:
  Expected<void> start();
  /// False: nobody is there to take it.
  bool send(const std::vector<std::string>& words) const;
  void finish();

  std::string program_;
  std::vector<std::string> first_;
  Limits limits_;
  pid_t child_ = -1;
  std::unique_ptr<Descriptor> talk_, err_;  ///< commands and answers; messages
};

}  // namespace gnomon::grade
