// A sweep as a Slurm job array: one shard per task, all in one folder that the nodes share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/expected.h"

namespace gnomon::app {

/// The batch script: task K of N writes DIR/shard-K. `arguments`: of gnomon sweep, quoted for a shell,
/// without the folder. Paths are absolute.
std::string slurm_script(const std::string& program, const std::string& arguments, const std::string& folder,
                         int tasks);
/// A line break in the script's words would begin a line of the script.
bool holds_line_break(std::string_view words);
/// sbatch's --output: the log of each task, DIR/slurm-K.log.
std::string log_pattern(const std::string& folder);
/// DIR/shard-1 … DIR/shard-N.
std::vector<std::string> shard_folders(const std::string& folder, int tasks);

/// Submits the script through sbatch and waits for all tasks. Errors are ErrorKind::graphics (resources): no
/// sbatch, or a task that failed; its log is DIR/slurm-K.log.
Expected<void> run_slurm_array(const std::string& script_path, const std::string& folder, int tasks);

}  // namespace gnomon::app
