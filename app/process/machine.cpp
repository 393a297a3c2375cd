#include "app/process/machine.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>
#include <optional>
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
double bytes_of(const char* path, std::string_view key) {
  const std::string kilobytes = field_of(path, key, ':');
  return kilobytes == "unknown" ? infinity : 1024.0 * std::strtod(kilobytes.c_str(), nullptr);
}

/// What ulimit -v leaves; infinite where there is no limit.
double available_addresses() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return infinity;
  return static_cast<double>(limit.rlim_cur) - bytes_of("/proc/self/status", "VmSize");
}

}  // namespace

std::optional<double> load_of_last_minute() {
  std::ifstream file("/proc/loadavg");
  double load = 0.0;
  return file >> load ? std::optional(load) : std::nullopt;
}

compare::MachineInfo machine_info() {
  return {field_of("/proc/cpuinfo", "model name", ':'), field_of("/etc/os-release", "PRETTY_NAME", '='),
          static_cast<int>(std::thread::hardware_concurrency()), load_of_last_minute()};
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

double available_memory() {
  return bytes_of("/proc/meminfo", "MemAvailable");
}

Expected<void> check_memory(ImageSize size, double bytes_per_pixel, double other_bytes) {
  const double picture = bytes_per_pixel * static_cast<double>(size.pixels());
  const double available = available_memory();
  if (picture > available)
    return fail(
        ErrorKind::graphics,
        fmt::format("--size: not enough memory (got {}x{}, which needs about {:.0f} GB; {:.0f} GB are left)",
                    size.width, size.height, picture / 1e9, available / 1e9));
  if (picture + other_bytes <= available_addresses()) return {};
  return fail(
      ErrorKind::graphics,
      fmt::format("not enough memory under the limit of this process (ulimit -v): about {:.0f} MB are "
                  "needed, {:.0f} MB are left",
                  (picture + other_bytes) / 1e6, std::max(0.0, available_addresses()) / 1e6));
}

}  // namespace gnomon::app
