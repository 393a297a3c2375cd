#include "scene/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <mutex>

#include "scene/base/interruptible.h"

namespace gnomon {
namespace {

using Range = tbb::blocked_range<std::size_t>;

}  // namespace

void parallel_ranges(std::size_t count, std::size_t at_a_time,
                     FunctionRef<void(std::size_t first, std::size_t last)> body) {
  const Interruptible* work = interruptible_work();
  tbb::parallel_for(Range(0, count, at_a_time), [&](const Range& range) {
    const ShareOf share(work);
    leave_if_interrupted();
    body(range.begin(), range.end());
  });
}

void parallel_tasks(std::size_t count, FunctionRef<void(std::size_t)> task) {
  const Interruptible* work = interruptible_work();
  const auto take = [&](const Range& range) {
    const ShareOf share(work);
    leave_if_interrupted();
    task(range.begin());
  };
  tbb::parallel_for(Range(0, count, 1), take, tbb::simple_partitioner());
}

struct ThreadSlots::Impl {
  tbb::enumerable_thread_specific<void*> slots{nullptr};
  std::mutex making;
};

ThreadSlots::ThreadSlots() : impl_(std::make_unique<Impl>()) {}
ThreadSlots::~ThreadSlots() = default;

void* ThreadSlots::local(FunctionRef<void*()> make) {
  void*& slot = impl_->slots.local();
  if (slot == nullptr) {
    const std::lock_guard lock(impl_->making);
    slot = make();
  }
  return slot;
}

void run_isolated(FunctionRef<void()> work) {
  tbb::this_task_arena::isolate([&] { work(); });
}

bool is_given_up() {
  return tbb::is_current_task_group_canceling();
}

int threads_for_loops() {
  return tbb::this_task_arena::max_concurrency();
}

int threads_in_use() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void limit_loops(int threads) {
  // For good: when it is taken back, oneTBB starts the threads that were not allowed.
  static const auto* kept = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
  static_cast<void>(kept);
}

}  // namespace gnomon
