#include "studies/commands/sweep_command.h"

#include <fmt/core.h>

#include "scene/base/option_text.h"
#include "scene/base/run_program.h"
#include "scene/files/links.h"

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

/// Slurm and its tasks write by names that can be known beforehand.
Expected<void> check_no_links(const std::string& folder, int tasks) {
  std::vector<std::string> names;
  for (int i = 1; i <= tasks; ++i)
    names.insert(names.end(), {fmt::format("shard-{}", i), fmt::format("slurm-{}.log", i)});
  return refuse_links(folder, names);
}

Expected<void> run_slurm_array(const std::string& script_path, const std::string& folder, int tasks) {
  if (auto plain = check_no_links(folder, tasks); !plain) return plain;
  std::vector<std::string> words{"sbatch",
                                 "--wait",
                                 "--parsable",
                                 fmt::format("--array=1-{}", tasks),
                                 "--output=" + log_pattern(folder),
                                 script_path};
  const auto code = run_program(std::move(words));
  if (!code) return fail(ErrorKind::graphics, "--slurm: " + code.error().reason);
  if (*code == 0) return {};
  return fail(
      ErrorKind::graphics,
      fmt::format("--slurm: the job array failed (sbatch gave {}); logs: {}/slurm-*.log", *code, folder));
}

}  // namespace gnomon::app
