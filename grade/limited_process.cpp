#include "grade/limited_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>

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

/// The caller looks at the time more closely (Meter); this ends the process should the caller be stopped. `used`, seconds.
void limit_time(pid_t process, double used, const Limits& limits) {
  rlimit limit{};
  prlimit(process, RLIMIT_CPU, nullptr, &limit);
  limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(std::ceil(used + limits.seconds)) + 1);
  prlimit(process, RLIMIT_CPU, &limit, nullptr);
}

/// Between fork and exec: system calls alone. `talk`: both stdin and stdout; -1: nothing is.
[[noreturn]] void become(const char* program, char* const* words, char* const* environment, int talk, int err,
                         const Limits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (talk < 0) talk = open("/dev/null", O_RDWR);
  dup2(talk, STDIN_FILENO);
  dup2(talk, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  limit_time(0, 0.0, limits);
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes of addresses
  set_limit(RLIMIT_AS, static_cast<rlim_t>(limits.memory_mb * 1e6));
#endif
  set_limit(RLIMIT_FSIZE, largest_file);
  set_limit(RLIMIT_CORE, 0);
  execve(program, words, environment);
  _exit(127);
}

/// What a child writes.
struct Ends {
  int err;           ///< -1: it is closed
  int answers = -1;  ///< -1: there are none, or no more
};

void read_message(int& from, std::string& text) {
  char buffer[4096];
  const ssize_t count = uninterrupted([&] { return read(from, buffer, sizeof buffer); });
  if (count <= 0) from = -1;
  const std::size_t room = longest_message - std::min(longest_message, text.size());
  text.append(buffer, std::min(room, static_cast<std::size_t>(std::max(count, ssize_t{0}))));
}

/// Waits for a message or an answer, and reads either. Returns the answer.
std::optional<int> listen(Ends& ends, int wait_ms, std::string& text) {
  pollfd wait[]{{ends.err, POLLIN, 0}, {ends.answers, POLLIN, 0}};
  if (poll(wait, 2, wait_ms) <= 0) return std::nullopt;
  if (wait[0].revents != 0) read_message(ends.err, text);
  if (wait[1].revents == 0) return std::nullopt;
  std::uint8_t code = 0;
  if (uninterrupted([&] { return read(ends.answers, &code, 1); }) == 1) return code;
  ends.answers = -1;
  return std::nullopt;
}

/// What stands there already.
void read_rest(Ends& ends, std::string& text) {
  ends.answers = -1;
  for (std::size_t read = text.size() + 1; ends.err >= 0 && read != text.size();) {
    read = text.size();
    listen(ends, 0, text);
  }
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// What a child that still runs has taken of the processor since this was made, and how long it has taken nothing.
class Meter {
 public:
  Meter(pid_t child, const Limits& limits) : limits_(limits) {
    known_ = clock_getcpuclockid(child, &clock_) == 0;
    begin_ = used_ = now().value_or(0.0);
    limit_time(child, begin_, limits);
  }

  /// Why it is to be ended; none: it may go on.
  std::optional<Outcome::End> look() {
    const auto used = now();
    if (!used) return std::nullopt;  // it has just ended
    if (is_too_much(*used)) return Outcome::End::out_of_time;
    if (*used > used_) used_ = *used, since_ = Clock::now();
    const std::chrono::duration<double> idle = Clock::now() - since_;
    if (idle.count() > limits_.idle_seconds) return Outcome::End::stalled;
    return std::nullopt;
  }
  /// `used`: by the child since its start, seconds.
  bool is_too_much(double used) const { return used - begin_ > limits_.seconds; }

 private:
  std::optional<double> now() const {
    timespec time{};
    if (!known_ || clock_gettime(clock_, &time) != 0) return std::nullopt;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  const Limits& limits_;
  clockid_t clock_{};
  bool known_ = false;
  double begin_ = 0.0, used_ = 0.0;  // seconds
  Clock::time_point since_ = Clock::now();
};

struct Followed {
  Outcome outcome;
  bool lives = false;  ///< it has answered
};

/// Until the child answers or ends, or is ended.
Followed follow(pid_t child, Ends ends, const Limits& limits) {
  constexpr int look_ms = 20;
  Meter meter(child, limits);
  Outcome outcome;
  int status = 0;
  rusage used{};
  while (wait4(child, &status, WNOHANG, &used) == 0) {
    if (const auto why = meter.look()) {
      outcome.end = *why;
      kill(child, SIGKILL);
      uninterrupted([&] { return wait4(child, &status, 0, &used); });
      return {outcome};
    }
    if (ends.err < 0) {
      usleep(2000);
    } else if (const auto code = listen(ends, look_ms, outcome.err)) {
      outcome.code = *code;
      read_rest(ends, outcome.err);
      return {outcome, true};
    }
  }
  read_rest(ends, outcome.err);
  if (meter.is_too_much(seconds_of(used.ru_utime) + seconds_of(used.ru_stime))) {
    outcome.end = Outcome::End::out_of_time;
  } else if (WIFSIGNALED(status)) {
    outcome.end = Outcome::End::killed;
    outcome.code = WTERMSIG(status);
  } else {
    outcome.code = WEXITSTATUS(status);
  }
  return {outcome};
}

/// Starts the program. `talk`, `err`: what become() takes.
Expected<pid_t> begin(const std::string& program, const std::vector<std::string>& words, int talk, int err,
                      const Limits& limits, const std::string& variable) {
  std::vector<char*> arguments{const_cast<char*>("gnomon")};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> environment;
  for (char** own = environ; *own != nullptr; ++own) environment.push_back(*own);
  if (!variable.empty()) environment.push_back(const_cast<char*>(variable.c_str()));
  environment.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0)
    return fail(ErrorKind::graphics, std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0) become(program.c_str(), arguments.data(), environment.data(), talk, err, limits);
  return child;
}

tl::unexpected<Error> no_pipe() {
  return fail(ErrorKind::graphics, std::string("cannot open a pipe: ") + std::strerror(errno));
}

}  // namespace

Expected<Outcome> run_limited(const std::string& program, const std::vector<std::string>& words,
                              const Limits& limits, const std::string& variable) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return no_pipe();
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const auto child = begin(program, words, -1, in.number(), limits, variable);
  if (!child) return fail(child.error());
  in.close();
  return follow(*child, {out.number()}, limits).outcome;
}

CommandProcess::CommandProcess(std::string program, std::vector<std::string> first, const Limits& limits)
    : program_(std::move(program)), first_(std::move(first)), limits_(limits) {}

CommandProcess::~CommandProcess() {
  finish();
}

Expected<void> CommandProcess::start() {
  int talk[2], err[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, talk) != 0) return no_pipe();
  talk_ = std::make_unique<Descriptor>(talk[0]);
  const Descriptor its_talk(talk[1]);
  if (pipe2(err, O_CLOEXEC) != 0) return no_pipe();
  err_ = std::make_unique<Descriptor>(err[0]);
  const Descriptor its_err(err[1]);
  const auto child = begin(program_, first_, its_talk.number(), its_err.number(), limits_, {});
  if (!child) return fail(child.error());
  child_ = *child;
  return {};
}

bool CommandProcess::send(const std::vector<std::string>& words) const {
  if (child_ < 0) return false;
  std::string text;
  for (const std::string& word : words) text.append(word).push_back('\0');
  text.push_back('\0');
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = uninterrupted(
        [&] { return ::send(talk_->number(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL); });
    if (count < 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

/// A process that waits for commands ends when there can be no more; it may have something to write still.
void CommandProcess::finish() {
  talk_.reset();
  if (child_ >= 0) follow(std::exchange(child_, -1), {err_->number()}, limits_);
  err_.reset();
}

Expected<Outcome> CommandProcess::run(const std::vector<std::string>& words) {
  if (!send(words)) {  // there is none yet, or somebody has ended it while it waited
    finish();
    if (const auto started = start(); !started) return fail(started.error());
    if (!send(words)) return fail(ErrorKind::graphics, "the process for drawings takes no commands");
  }
  auto [outcome, lives] = follow(child_, {err_->number(), talk_->number()}, limits_);
  if (!lives) child_ = -1;
  if (!lives || outcome.code != 0) finish();
  return std::move(outcome);
}

}  // namespace gnomon::grade
