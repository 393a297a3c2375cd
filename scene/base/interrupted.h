// Calls of the system that a signal interrupts (EINTR) have not failed: they are made again.
#pragma once

#include <cerrno>

namespace gnomon {

/// Makes a call that answers -1 and EINTR where a signal came, until it answers something else.
template <class Call>
auto uninterrupted(const Call& call) {
  for (;;) {
    const auto answer = call();
    if (answer != -1 || errno != EINTR) return answer;
  }
}

}  // namespace gnomon
