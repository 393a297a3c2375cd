#include "scene/base/interruptible.h"

#include <utility>

namespace gnomon {
namespace {

thread_local const Interruptible* innermost = nullptr;

}  // namespace

Interruptible::Interruptible(std::function<bool()> ends)
    : ends_(std::move(ends)), around_(std::exchange(innermost, this)) {}

Interruptible::~Interruptible() {
  innermost = around_;
}

ShareOf::ShareOf(const Interruptible* work) : before_(std::exchange(innermost, work)) {}

ShareOf::~ShareOf() {
  innermost = before_;
}

const Interruptible* interruptible_work() {
  return innermost;
}

bool is_interrupted() {
  return innermost != nullptr && innermost->has_ended();
}

void leave_if_interrupted() {
  if (is_interrupted()) throw Interrupted();
}

}  // namespace gnomon
