// SIGINT and SIGTERM end the process at once with 130 or 143, except while outputs are being written. Those are finished
// first, so that what stands in the output folder is always one whole result. Programs that were started are ended.
// Temporary folders are removed before the process ends.
#pragma once

#include <list>
#include <mutex>
#include <string>
#include <string_view>

namespace gnomon::app {

/// To be called before any other thread exists: the signals are then taken by one thread that waits for them.
/// A signal that the caller had set to be ignored stays ignored.
void watch_for_interrupts();

/// Before this process becomes another program, which would inherit that nothing but SIGKILL ends it: from here on the
/// signals do what the system does with them.
void leave_interrupts_to_the_system();

/// 0: no signal has come. Else 130 or 143, with which the process ends once its outputs are finished.
int interrupt_exit_code();

/// Ends the process where it stands, with "gnomon: WORDS" on stderr; temporary folders and unpublished outputs are removed.
[[noreturn]] void end_process(int exit_code, std::string_view words);

/// While one lives, a signal waits.
class OutputGuard {
 public:
  OutputGuard();

 private:
  std::unique_lock<std::mutex> lock_;
};

/// A new folder for temporary files; it goes with all that is in it, also when a signal ends the process.
class TemporaryFolder {
 public:
  /// `name`: the start of the folder's own name.
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return *place_; }  ///< empty: it could not be made

 private:
  std::list<std::string>::iterator place_;
};

}  // namespace gnomon::app
