// What the program runs on.
#pragma once

#include <cstdint>

#include "compare/comparison.h"

namespace gnomon::app {

/// From /proc/cpuinfo and /etc/os-release; "unknown" where they do not say.
compare::MachineInfo machine_info();

/// The most memory that the process has held at a time so far.
std::uint64_t peak_memory_bytes();

}  // namespace gnomon::app
