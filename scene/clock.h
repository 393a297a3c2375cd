// The clocks of the system.
#pragma once

#include <ctime>

namespace gnomon {

/// Milliseconds of a clock of clock_gettime().
inline double clock_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace gnomon
