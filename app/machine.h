// What the program runs on.
#pragma once

#include <cstdint>

#include "compare/comparison.h"
#include "scene/expected.h"
#include "scene/image.h"

namespace gnomon::app {

/// From /proc/cpuinfo and /etc/os-release; "unknown" where they do not say.
compare::MachineInfo machine_info();

/// The most memory that the process has held at a time so far.
std::uint64_t peak_memory_bytes();

/// ErrorKind::graphics when a picture of this size needs more memory than the machine has left, which would
/// end the process without a word.
Expected<void> check_memory(ImageSize size, double bytes_per_pixel);

}  // namespace gnomon::app
