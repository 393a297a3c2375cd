#include "lab/view/work/priority.h"

#include <sys/resource.h>
#include <tbb/task_scheduler_observer.h>

namespace gnomon::lab {

/// Linux counts a thread as a process here: only the calling one is meant. A system that refuses loses nothing but
/// smoothness.
void give_way(int nice) {
  if (getpriority(PRIO_PROCESS, 0) < nice) setpriority(PRIO_PROCESS, 0, nice);
}

struct HelpersGiveWay::Observer final : tbb::task_scheduler_observer {
  explicit Observer(int value) : nice(value) { observe(true); }
  ~Observer() override { observe(false); }
  void on_scheduler_entry(bool is_worker) override {
    if (is_worker) give_way(nice);
  }
  int nice;
};

HelpersGiveWay::HelpersGiveWay(int nice) : observer_(std::make_unique<Observer>(nice)) {}
HelpersGiveWay::~HelpersGiveWay() = default;

}  // namespace gnomon::lab
