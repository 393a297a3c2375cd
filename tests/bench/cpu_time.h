// CPU time, which other programs on the machine disturb little.
#pragma once

#include <ctime>

namespace gnomon::bench {

/// Milliseconds of the process's own, all threads; for one thread the wall clock's, but for other programs'
/// share.
inline double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace gnomon::bench
