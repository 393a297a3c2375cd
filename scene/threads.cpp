#include "scene/threads.h"

#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace gnomon {
namespace {

thread_local int handled_refusals = 0;
std::atomic<int> refused{0};

}  // namespace

int startable_threads(int wanted) {
  const RefusalIsHandled goes_on;
  std::vector<std::thread> threads;
  std::promise<void> enough;
  const std::shared_future<void> end = enough.get_future().share();
  try {
    while (static_cast<int>(threads.size()) < wanted) threads.emplace_back([end] { end.wait(); });
  } catch (const std::system_error&) {  // no more
  }
  enough.set_value();
  for (std::thread& thread : threads) thread.join();
  return static_cast<int>(threads.size());
}

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

}  // namespace gnomon
