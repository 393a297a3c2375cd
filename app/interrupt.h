// SIGINT and SIGTERM end the process at once with 130 or 143, except while outputs are being written: those
// are finished first, so that what stands in the output folder is always one whole result.
#pragma once

#include <mutex>

namespace gnomon::app {

/// To be called before any other thread exists: the signals are then taken by one thread that waits for them.
/// A signal that the caller had set to be ignored stays ignored.
void watch_for_interrupts();

/// Before this process becomes another program, which would inherit that nothing but SIGKILL ends it: from here on the
/// signals do what the system does with them.
void leave_interrupts_to_the_system();

/// 0: no signal has come. Else 130 or 143, with which the process ends once its outputs are finished.
int interrupt_exit_code();

/// While one lives, a signal waits.
class OutputGuard {
 public:
  OutputGuard();

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace gnomon::app
