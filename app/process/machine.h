// What the program runs on.
#pragma once

#include <cstdint>

#include "compare/comparison.h"
#include "scene/base/expected.h"
#include "scene/image.h"

namespace gnomon::app {

/// From /proc/cpuinfo and /etc/os-release; "unknown" where they do not say.
compare::MachineInfo machine_info();

/// The most memory that the process has held at a time so far.
std::uint64_t peak_memory_bytes();

/// What the machine could still give, bytes; infinite where it does not say.
double available_memory();

/// What an OpenGL context of Mesa takes of the address space besides pictures and maps, bytes (measured: below it
/// Mesa and LLVM run out of memory, and not always with an error).
inline constexpr double graphics_bytes = 480e6;

/// ErrorKind::graphics when a picture of this size, and so many bytes besides, needs more memory than the machine
/// or a limit (ulimit -v) has left, which would end the process without a word.
Expected<void> check_memory(ImageSize size, double bytes_per_pixel, double other_bytes = 0.0);

}  // namespace gnomon::app
