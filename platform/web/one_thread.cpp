// The loops of scene/base/parallel.h and what runs beside them, where there is one thread: a page starts others only under
// headers that a plain host does not send.
#include <algorithm>
#include <utility>

#include "scene/base/interruptible.h"
#include "scene/base/parallel.h"
#include "scene/base/threads.h"

namespace gnomon {

void parallel_ranges(std::size_t count, std::size_t,
                     FunctionRef<void(std::size_t first, std::size_t last)> body) {
  if (count > 0) body(0, count);
}

void parallel_tasks(std::size_t count, FunctionRef<void(std::size_t)> task) {
  for (std::size_t i = 0; i < count; ++i) task(i);
}

struct ThreadSlots::Impl {
  void* slot = nullptr;
};

ThreadSlots::ThreadSlots() : impl_(std::make_unique<Impl>()) {}
ThreadSlots::~ThreadSlots() = default;

void* ThreadSlots::local(FunctionRef<void*()> make) {
  if (impl_->slot == nullptr) impl_->slot = make();
  return impl_->slot;
}

void run_isolated(FunctionRef<void()> work) {
  work();
}

bool is_given_up() {
  return false;  // an exception leaves a loop at once
}

int threads_for_loops() {
  return 1;
}

int threads_in_use() {
  return 1;
}

void limit_loops(int) {}

// Nothing new is heard of before a turn is over: the work is never left, and who asks afterwards is told as elsewhere.

Interruptible::Interruptible(std::function<bool()> ends) : ends_(std::move(ends)), around_(nullptr) {}
Interruptible::~Interruptible() = default;
ShareOf::ShareOf(const Interruptible*) : before_(nullptr) {}
ShareOf::~ShareOf() = default;

const Interruptible* interruptible_work() {
  return nullptr;
}

bool is_interrupted() {
  return false;
}

void leave_if_interrupted() {}

/// Nobody is refused one: who asks has the work done on the thread there is.
int startable_threads(int wanted) {
  return wanted;
}

std::launch background_launch() {
  return std::launch::deferred;
}

void sort_numbers(std::span<std::uint64_t> values) {
  std::sort(values.begin(), values.end());
}

}  // namespace gnomon
