#include "app/grade/limited_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "scene/files/descriptor.h"

namespace gnomon::app::grade {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_message = std::size_t{64} * 1024;  // bytes
constexpr rlim_t largest_file = rlim_t{512} * 1024 * 1024;       // bytes

void set_limit(decltype(RLIMIT_CPU) which, rlim_t value) {
  const rlimit limit{value, value};
  setrlimit(which, &limit);
}

/// Between fork and exec: system calls alone.
[[noreturn]] void become(char* const* words, int err, const Limits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  // Wall time ends the process (below); this ends it should the caller be stopped. Two threads may compile.
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)) * 4 + 1);
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes of addresses
  set_limit(RLIMIT_AS, static_cast<rlim_t>(limits.memory_mb * 1e6));
#endif
  set_limit(RLIMIT_FSIZE, largest_file);
  set_limit(RLIMIT_CORE, 0);
  execv("/proc/self/exe", words);
  _exit(127);
}

int ms_until(Clock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
  return left > 0 ? static_cast<int>(left) + 1 : 0;
}

/// Until the other end is closed, or the time is over: false.
bool read_until(int from, Clock::time_point end, std::string& text) {
  pollfd wait{from, POLLIN, 0};
  for (;;) {
    const int left = ms_until(end);
    if (left == 0) return false;
    const int ready = poll(&wait, 1, left);
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    char buffer[4096];
    const ssize_t count = read(from, buffer, sizeof buffer);
    if (count <= 0) return true;
    const std::size_t room = longest_message - std::min(longest_message, text.size());
    text.append(buffer, std::min(room, static_cast<std::size_t>(count)));
  }
}

/// Its stderr may be closed while it still runs.
bool wait_until(pid_t child, Clock::time_point end, int& status) {
  constexpr useconds_t pause = 2000;  // microseconds
  for (;;) {
    if (waitpid(child, &status, WNOHANG) != 0) return true;
    if (ms_until(end) == 0) return false;
    usleep(pause);
  }
}

}  // namespace

Expected<Outcome> run_limited(const std::vector<std::string>& words, const Limits& limits) {
  std::vector<char*> arguments{const_cast<char*>("gnomon")};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return fail(ErrorKind::graphics, std::string("cannot open a pipe: ") + std::strerror(errno));
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const pid_t child = fork();
  if (child < 0)
    return fail(ErrorKind::graphics, std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0) become(arguments.data(), in.number(), limits);
  in.close();
  const auto end = Clock::now() +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  Outcome outcome;
  int status = 0;
  const bool ended = read_until(out.number(), end, outcome.err) && wait_until(child, end, status);
  if (!ended) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    outcome.end = Outcome::End::timed_out;
  } else if (WIFSIGNALED(status)) {
    outcome.end = Outcome::End::killed;
    outcome.code = WTERMSIG(status);
  } else {
    outcome.code = WEXITSTATUS(status);
  }
  return outcome;
}

}  // namespace gnomon::app::grade
