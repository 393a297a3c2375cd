// Other programs that this one starts and waits for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

/// What a program is started with beside its words.
struct ProgramStart {
  std::vector<int> descriptors{};  ///< this program's, which it has, too
  /// Called on a thread of its own, which then starts the program: what that thread has given up, the program has not either.
  std::function<void()> give_up{};
  /// Called every few milliseconds while the program runs.
  std::function<void()> meanwhile{};
};

/// Runs a program of the PATH with these words, of which the first is its name, and waits for its end. What it says goes to
/// the descriptor `output`, where messages go unless another is named: this program's stdout is for data. Signals reach it
/// though this program's threads block some.
/// It has no stdin, and is with all that it starts a process group of its own. That is ended when it takes longer than
/// `longest_s` seconds, or when the work that waits for it is interrupted (interruptible.h). Returns its exit code, or 128 and
/// the signal that ended it. ErrorKind::graphics: it cannot be started, it was ended.
Expected<int> run_program(std::vector<std::string> words, std::optional<double> longest_s = std::nullopt,
                          int output = 2, const ProgramStart& start = {});

/// How a program ended, and the first megabyte of what it said.
struct ProgramEnd {
  int code = 0;
  std::string said{};
};

/// As run_program(), but what the program says is kept and returned. `on_line` is called with each line as it comes.
/// ErrorKind::graphics, too, where there is no memory for it.
Expected<ProgramEnd> run_and_listen(std::vector<std::string> words,
                                    std::optional<double> longest_s = std::nullopt,
                                    const std::function<void(std::string_view)>& on_line = {});

/// While one lives, end_programs() waits for its end, some seconds at most.
class WaitedFor {
 public:
  WaitedFor();
  ~WaitedFor();
  WaitedFor(const WaitedFor&) = delete;
  WaitedFor& operator=(const WaitedFor&) = delete;
};

/// Programs that run are ended, which is waited for some seconds at most, and no other is started any more: this process is
/// about to end.
void end_programs();

}  // namespace gnomon
