#include "app/machine.h"

#include <sys/resource.h>

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

}  // namespace gnomon::app
