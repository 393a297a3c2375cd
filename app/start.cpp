// What the libraries do before main() and nobody here needs.
#include <hwy/nanobenchmark.h>

namespace hwy::platform {

/// In the place of Highway's own, whose library finds the resolution of its timer out whenever it is loaded,
/// for its benchmarks alone: 3 ms of every start, as long as a small scene takes to load.
uint64_t TimerResolution() {
  return 1;
}

}  // namespace hwy::platform
