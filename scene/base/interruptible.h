// Work that is not worth its end when something newer is asked for. It is left by an exception, which the loops of parallel.h, the
// fills of raster/gl/fill.h and programs that are waited for (run_program.h) throw or heed; its caller catches that.
#pragma once

#include <atomic>
#include <exception>
#include <functional>

namespace gnomon {

/// What an Interruptible work is left by.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "left for something newer"; }
};

/// While one lives, what its thread does, with the loops over all threads that it begins, is left soon after `ends` has become true.
/// Any of these threads calls `ends`, thousands of times in a second: it takes no lock.
class Interruptible {
 public:
  explicit Interruptible(std::function<bool()> ends);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  /// Once true it stays so.
  bool has_ended() const { return ended_ || (ended_ = ends_()); }

 private:
  std::function<bool()> ends_;
  mutable std::atomic<bool> ended_ = false;
  const Interruptible* around_;
};

/// Makes another thread's share part of the same work, or of none (null), while one lives.
class ShareOf {
 public:
  explicit ShareOf(const Interruptible* work);
  ~ShareOf();
  ShareOf(const ShareOf&) = delete;
  ShareOf& operator=(const ShareOf&) = delete;

 private:
  const Interruptible* before_;
};

/// The innermost one of the calling thread; null: nothing interrupts what it does.
const Interruptible* interruptible_work();
/// Whether the calling thread is to leave its work.
bool is_interrupted();
/// Throws Interrupted where it is.
void leave_if_interrupted();

}  // namespace gnomon
