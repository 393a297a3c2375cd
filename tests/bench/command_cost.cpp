#include "command_cost.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "bench_support.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/files/write_file.h"
#include "tests/support/places.h"

namespace gnomon::bench {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

[[noreturn]] void become(const Words& words) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

}  // namespace

Cost operator+(const Cost& a, const Cost& b) {
  return {a.wall + b.wall, a.processor + b.processor, std::max(a.memory, b.memory)};
}

Cost cost_of(Words words) {
  words.insert(words.begin(), test::program());
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) become(words);
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0) {
    fmt::print(stderr, "{}: failed\n", fmt::join(words, " "));
    std::exit(1);
  }
  return {1e-3 * watch.elapsed_ms(), seconds(used.ru_utime) + seconds(used.ru_stime),
          1024.0 * static_cast<double>(used.ru_maxrss)};
}

void Least::add(const Cost& run) {
  cost = {std::min(cost.wall, run.wall), std::min(cost.processor, run.processor),
          std::min(cost.memory, run.memory)};
}

std::string written_glb(const Scene& scene, const std::string& path) {
  const auto file = must(write_gltf(scene, true));
  must(write_file(path, file.bytes));
  return path;
}

}  // namespace gnomon::bench
