#include <future>
#include <system_error>
#include <thread>
#include <vector>

#include "scene/base/threads.h"

namespace gnomon {

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

std::launch background_launch() {
  return std::launch::async | std::launch::deferred;
}

}  // namespace gnomon
