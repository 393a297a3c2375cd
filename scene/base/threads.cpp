#include "scene/base/threads.h"

#include <fmt/core.h>

#include <atomic>
#include <new>
#include <system_error>

namespace gnomon {
namespace {

thread_local int handled_refusals = 0;
std::atomic<int> refused{0};

}  // namespace

RefusalIsHandled::RefusalIsHandled() {
  ++handled_refusals;
}
RefusalIsHandled::~RefusalIsHandled() {
  --handled_refusals;
}
bool RefusalIsHandled::here() {
  return handled_refusals > 0;
}

int refused_threads() {
  return refused;
}
void count_refused_thread() {
  ++refused;
}

bool is_of_resource(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
         dynamic_cast<const std::system_error*>(&error) != nullptr || refused_threads() > 0;
}

Error unforeseen(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return {ErrorKind::graphics, "out of memory"};
  if (dynamic_cast<const std::system_error*>(&error) != nullptr)
    return {ErrorKind::graphics, fmt::format("the system refuses a resource: {}", error.what())};
  if (refused_threads() > 0)
    return {ErrorKind::graphics, fmt::format("not enough threads can be started ({})", thread_limit_words)};
  return {ErrorKind::internal, fmt::format("internal error: {}", error.what())};
}

}  // namespace gnomon
