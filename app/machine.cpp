#include "app/machine.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

namespace gnomon::app {

namespace {

/// The text after `separator` on the first line that starts with `key`, without quotes.
std::string field_of(const char* path, std::string_view key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    std::string value = line.substr(std::min(line.find(separator) + 1, line.size()));
    std::erase(value, '"');
    return value.substr(std::min(value.find_first_not_of(" \t"), value.size()));
  }
  return "unknown";
}

/// Bytes; infinite where the system does not say.
double available_memory() {
  const std::string kilobytes = field_of("/proc/meminfo", "MemAvailable", ':');
  return kilobytes == "unknown" ? infinity : 1024.0 * std::strtod(kilobytes.c_str(), nullptr);
}

}  // namespace

compare::MachineInfo machine_info() {
  return {field_of("/proc/cpuinfo", "model name", ':'), field_of("/etc/os-release", "PRETTY_NAME", '='),
          static_cast<int>(std::thread::hardware_concurrency())};
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

Expected<void> check_memory(ImageSize size, double bytes_per_pixel) {
  const double needed = bytes_per_pixel * static_cast<double>(size.pixels());
  const double available = available_memory();
  if (needed <= available) return {};
  return fail(
      ErrorKind::graphics,
      fmt::format("--size: not enough memory (got {}x{}, which needs about {:.0f} GB; {:.0f} GB are left)",
                  size.width, size.height, needed / 1e9, available / 1e9));
}

}  // namespace gnomon::app
