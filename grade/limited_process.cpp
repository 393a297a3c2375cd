#include "grade/limited_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <optional>

#include "scene/base/interrupted.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_message = std::size_t{64} * 1024;  // bytes
constexpr rlim_t largest_file = rlim_t{512} * 1024 * 1024;       // bytes

void set_limit(decltype(RLIMIT_CPU) which, rlim_t value) {
  const rlimit limit{value, value};
  setrlimit(which, &limit);
}

/// Between fork and exec: system calls alone.
[[noreturn]] void become(const char* program, char* const* words, char* const* environment, int err,
                         const Limits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  // The caller looks at the time more closely (below); this ends the process should the caller be stopped.
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)) + 1);
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes of addresses
  set_limit(RLIMIT_AS, static_cast<rlim_t>(limits.memory_mb * 1e6));
#endif
  set_limit(RLIMIT_FSIZE, largest_file);
  set_limit(RLIMIT_CORE, 0);
  execve(program, words, environment);
  _exit(127);
}

/// Reads on for a short while. False: the other end is closed.
bool read_some(int from, int wait_ms, std::string& text) {
  pollfd wait{from, POLLIN, 0};
  const int ready = poll(&wait, 1, wait_ms);
  if (ready < 0) return errno == EINTR;
  if (ready == 0) return true;
  char buffer[4096];
  const ssize_t count = uninterrupted([&] { return read(from, buffer, sizeof buffer); });
  if (count <= 0) return false;
  const std::size_t room = longest_message - std::min(longest_message, text.size());
  text.append(buffer, std::min(room, static_cast<std::size_t>(count)));
  return true;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// What a child that still runs has taken of the processor, and how long it has taken nothing.
class Meter {
 public:
  Meter(pid_t child, const Limits& limits) : limits_(limits) {
    known_ = clock_getcpuclockid(child, &clock_) == 0;
  }

  /// Why it is to be ended; none: it may go on.
  std::optional<Outcome::End> look() {
    timespec now{};
    if (!known_ || clock_gettime(clock_, &now) != 0) return std::nullopt;  // it has just ended
    const double used = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    if (used > limits_.seconds) return Outcome::End::out_of_time;
    if (used > used_) used_ = used, since_ = Clock::now();
    const std::chrono::duration<double> idle = Clock::now() - since_;
    if (idle.count() > limits_.idle_seconds) return Outcome::End::stalled;
    return std::nullopt;
  }

 private:
  const Limits& limits_;
  clockid_t clock_{};
  bool known_ = false;
  double used_ = 0.0;  // seconds
  Clock::time_point since_ = Clock::now();
};

/// Until the child ends, or is ended.
Outcome follow(pid_t child, int from, const Limits& limits) {
  constexpr int look_ms = 20;
  Meter meter(child, limits);
  Outcome outcome;
  int status = 0;
  rusage used{};
  bool open = true;
  while (wait4(child, &status, WNOHANG, &used) == 0) {
    if (const auto why = meter.look()) {
      outcome.end = *why;
      kill(child, SIGKILL);
      uninterrupted([&] { return wait4(child, &status, 0, &used); });
      return outcome;
    }
    if (open) open = read_some(from, look_ms, outcome.err);
    if (!open) usleep(2000);
  }
  for (std::size_t read = 0; open && read != outcome.err.size();) {  // what it said last
    read = outcome.err.size();
    open = read_some(from, 0, outcome.err);
  }
  if (seconds_of(used.ru_utime) + seconds_of(used.ru_stime) > limits.seconds) {
    outcome.end = Outcome::End::out_of_time;
  } else if (WIFSIGNALED(status)) {
    outcome.end = Outcome::End::killed;
    outcome.code = WTERMSIG(status);
  } else {
    outcome.code = WEXITSTATUS(status);
  }
  return outcome;
}

}  // namespace

Expected<Outcome> run_limited(const std::string& program, const std::vector<std::string>& words,
                              const Limits& limits, const std::string& variable) {
  std::vector<char*> arguments{const_cast<char*>("gnomon")};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> environment;
  for (char** own = environ; *own != nullptr; ++own) environment.push_back(*own);
  if (!variable.empty()) environment.push_back(const_cast<char*>(variable.c_str()));
  environment.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return fail(ErrorKind::graphics, std::string("cannot open a pipe: ") + std::strerror(errno));
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const pid_t child = fork();
  if (child < 0)
    return fail(ErrorKind::graphics, std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0) become(program.c_str(), arguments.data(), environment.data(), in.number(), limits);
  in.close();
  return follow(child, out.number(), limits);
}

}  // namespace gnomon::grade
