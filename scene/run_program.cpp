#include "scene/run_program.h"

#include <fmt/core.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace gnomon {
namespace {

/// What posix_spawnp() is told of the child: stdout to stderr, no signal blocked.
class ChildSettings {
 public:
  ChildSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
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

}  // namespace

Expected<int> run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto failed = [&](std::string_view what, int error_number) {
    return fail(ErrorKind::graphics, fmt::format("{} {}: {}", words[0], what, std::strerror(error_number)));
  };
  const ChildSettings settings;
  pid_t child = 0;
  if (const int error = posix_spawnp(&child, arguments[0], &settings.actions, &settings.attributes,
                                     arguments.data(), environ);
      error != 0)
    return failed("cannot be started", error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return failed("cannot be waited for", errno);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);  // as a shell counts
}

}  // namespace gnomon
