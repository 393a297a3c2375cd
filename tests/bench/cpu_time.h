// CPU time, which other programs on the machine disturb little.
#pragma once

#include "scene/base/stages.h"

namespace gnomon::bench {

/// Milliseconds of the process's own, all threads.
inline double cpu_ms() {
  return clock_ms(CLOCK_PROCESS_CPUTIME_ID);
}
/// Of the calling thread's own: for work on one thread the wall clock's, but for other programs' share, and without what idle
/// workers of earlier work take before they sleep.
inline double thread_ms() {
  return clock_ms(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace gnomon::bench
