#include "app/sweep/slurm.h"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "app/shell.h"

namespace gnomon::app {

std::string slurm_script(const std::string& program, const std::string& arguments, const std::string& folder,
                         int tasks) {
  return fmt::format(
      "#!/bin/sh\n#SBATCH --job-name=gnomon-sweep\n"
      "exec {} sweep{} --quiet --shard \"$SLURM_ARRAY_TASK_ID/{}\" -o {}/shard-\"$SLURM_ARRAY_TASK_ID\"\n",
      shell_quoted(program), arguments, tasks, shell_quoted(folder));
}

bool holds_line_break(std::string_view words) {
  return words.find_first_of("\n\r") != std::string_view::npos;
}

std::string log_pattern(const std::string& folder) {
  std::string pattern;
  for (const char c : folder) pattern += c == '%' ? std::string("%%") : std::string(1, c);
  return pattern + "/slurm-%a.log";
}

std::vector<std::string> shard_folders(const std::string& folder, int tasks) {
  std::vector<std::string> folders;
  for (int i = 1; i <= tasks; ++i) folders.push_back(fmt::format("{}/shard-{}", folder, i));
  return folders;
}

Expected<void> run_slurm_array(const std::string& script_path, const std::string& folder, int tasks) {
  std::vector<std::string> words{"sbatch",
                                 "--wait",
                                 "--parsable",
                                 fmt::format("--array=1-{}", tasks),
                                 "--output=" + log_pattern(folder),
                                 script_path};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // sbatch prints the job's number; stdout is for data, so it goes where messages go.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    return fail(ErrorKind::graphics, fmt::format("--slurm: cannot start sbatch: {}", std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      return fail(ErrorKind::graphics,
                  fmt::format("--slurm: lost sight of sbatch: {}", std::strerror(errno)));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return fail(ErrorKind::graphics,
              fmt::format("--slurm: the job array failed (sbatch gave {}); logs: {}/slurm-*.log",
                          WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), folder));
}

}  // namespace gnomon::app
