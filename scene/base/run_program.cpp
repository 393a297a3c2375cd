#include "scene/base/run_program.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>

#include "scene/base/interruptible.h"
#include "scene/base/threads.h"
#include "scene/base/timing.h"

namespace gnomon {
namespace {

constexpr useconds_t pause_us = 10000;  // between two looks at a program
constexpr double grace_ms = 1000.0;     // for what a program does when it is asked to end

// As signals are, the process's.
std::atomic<bool> process_ends{false};
std::atomic<int> running{0};

/// What posix_spawnp() is told of the child: no stdin, stdout and stderr to `output`, no signal blocked, a process group of its own.
class ChildSettings {
 public:
  ChildSettings(int output, const std::vector<int>& descriptors) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    for (const int kept : descriptors)  // onto itself: it is not closed when the program starts
      posix_spawn_file_actions_adddup2(&actions, kept, kept);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~ChildSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  ChildSettings(const ChildSettings&) = delete;
  ChildSettings& operator=(const ChildSettings&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

/// Returns 0 and the child, or the number of an error.
int spawn(char* const* words, const ChildSettings& settings, pid_t& child) {
  return posix_spawnp(&child, words[0], &settings.actions, &settings.attributes, words, environ);
}

/// The same on a thread that has given something up before.
int spawn_without(const std::function<void()>& give_up, char* const* words, const ChildSettings& settings,
                  pid_t& child) {
  int error = EAGAIN;
  try {
    const RefusalIsHandled is_told;
    std::thread([&] {
      give_up();
      error = spawn(words, settings, child);
    }).join();
  } catch (const std::system_error&) {  // no thread
  }
  return error;
}

/// Looks until the child has ended; its group is asked to end, and then made to, when `stop()` says so.
template <class Stop>
Expected<int> wait_for(pid_t child, const Stop& stop) {
  std::optional<Stopwatch> asked;
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) return fail(ErrorKind::graphics, std::strerror(errno));
    if (ended == child) {
      if (asked) kill(-child, SIGKILL);                                         // what it has left behind
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);  // as a shell counts
    }
    if (!asked && stop()) {
      asked.emplace();
      kill(-child, SIGTERM);
    } else if (asked && asked->elapsed_ms() > grace_ms) {
      kill(-child, SIGKILL);
    }
    usleep(pause_us);
  }
}

/// Hands over the whole lines of a file that another process writes.
struct LineReader {
  int file;
  const std::function<void(std::string_view)>& on_line;
  off_t place = 0;
  std::string begun{};

  void read() {
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = pread(file, piece.data(), piece.size(), place)) > 0; place += count) {
      begun.append(piece.data(), static_cast<std::size_t>(count));
      for (std::size_t end = 0; (end = begun.find('\n')) != std::string::npos; begun.erase(0, end + 1))
        on_line(std::string_view(begun).substr(0, end));
    }
  }
};

}  // namespace

WaitedFor::WaitedFor() {
  ++running;
}
WaitedFor::~WaitedFor() {
  --running;
}

void end_programs() {
  process_ends = true;
  const Stopwatch watch;
  while (running > 0 && watch.elapsed_ms() < 3.0 * grace_ms) usleep(pause_us);
}

Expected<int> run_program(std::vector<std::string> words, std::optional<double> longest_s, int output,
                          const ProgramStart& start) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto failed = [&](const std::string& what) {
    return fail(ErrorKind::graphics, fmt::format("{} {}", words[0], what));
  };
  const WaitedFor counted;
  if (process_ends) return failed("is not started any more");
  const ChildSettings settings(output, start.descriptors);
  pid_t child = 0;
  if (const int error = start.give_up ? spawn_without(start.give_up, arguments.data(), settings, child)
                                      : spawn(arguments.data(), settings, child);
      error != 0)
    return failed(fmt::format("cannot be started: {}", std::strerror(error)));
  const Stopwatch watch;
  bool late = false;
  const auto code = wait_for(child, [&] {
    if (start.meanwhile) start.meanwhile();
    late = longest_s && watch.elapsed_ms() > 1e3 * *longest_s;
    return late || process_ends || is_interrupted();
  });
  if (!code) return failed("cannot be waited for: " + code.error().reason);
  if (late) return failed(fmt::format("did not end within {:.3g} s, and was ended", *longest_s));
  if (process_ends || is_interrupted()) return failed("was ended");
  return code;
}

Expected<ProgramEnd> run_and_listen(std::vector<std::string> words, std::optional<double> longest_s,
                                    const std::function<void(std::string_view)>& on_line) {
  constexpr std::size_t longest_said = 1 << 20;
  const int file = memfd_create("gnomon-said", MFD_CLOEXEC);
  if (file < 0)
    return fail(ErrorKind::graphics, fmt::format("cannot make a file in memory: {}", std::strerror(errno)));
  LineReader lines{file, on_line};
  ProgramStart start;
  if (on_line) start.meanwhile = [&] { lines.read(); };
  const auto code = run_program(std::move(words), longest_s, file, start);
  if (on_line) lines.read();
  ProgramEnd end{code.value_or(0), std::string(longest_said, '\0')};
  const ssize_t read = pread(file, end.said.data(), end.said.size(), 0);
  const int error = errno;
  close(file);
  if (!code) return fail(code.error());
  if (read < 0)
    return fail(ErrorKind::graphics, fmt::format("cannot read what it said: {}", std::strerror(error)));
  end.said.resize(static_cast<std::size_t>(read));
  return end;
}

}  // namespace gnomon
