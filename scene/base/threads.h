// Threads that the system may refuse (a limit on processes, ulimit -u): how many there can be, and work that goes on
// without one. Loops over all threads are those of scene/base/parallel.h.
#pragma once

#include <exception>
#include <future>
#include <memory>
#include <utility>

#include "scene/base/expected.h"

namespace gnomon {

/// How many more threads the system lets this process start, up to `wanted`: they are started, and ended again.
int startable_threads(int wanted);
/// How in_background() runs its work: at once on a thread of its own where the platform has threads.
std::launch background_launch();

/// The words for an error: "`what` needs N more threads, and ...".
inline constexpr const char* thread_limit_words = "a limit on processes, ulimit -u";

/// While one lives, who starts a thread on this thread has something to do instead where it is refused.
class RefusalIsHandled {
 public:
  RefusalIsHandled();
  ~RefusalIsHandled();
  RefusalIsHandled(const RefusalIsHandled&) = delete;
  RefusalIsHandled& operator=(const RefusalIsHandled&) = delete;
  /// Whether one lives on the calling thread.
  static bool here();
};

/// Threads that were refused to somebody who had nothing else to do. They are counted by the program alone
/// (app/process/machine.h); where a library is all that is used of Gnomon, 0.
int refused_threads();
void count_refused_thread();

/// Whether an exception says that memory, a thread or another resource of the system is missing. oneTBB's exception for a
/// refused thread has no type of its own.
bool is_of_resource(const std::exception& error);
/// What is said of an exception that nothing nearer answers for: ErrorKind::graphics where a resource is missing, else
/// ErrorKind::internal.
Error unforeseen(const std::exception& error);

/// work() on a thread of its own, or, where none can be started, on the one that asks for its result.
template <class Work>
auto in_background(Work work) {
  const RefusalIsHandled goes_on;
  // By a pointer: libstdc++'s async() has moved its function away when it finds that no thread can be started, and then
  // takes what is left for the function to call.
  const auto kept = std::make_shared<Work>(std::move(work));
  return std::async(background_launch(), [kept] { return (*kept)(); });
}

}  // namespace gnomon
