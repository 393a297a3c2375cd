// What gnomon sweep was asked for, and how it is said again: to the journal, to compare, to a job array.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/options/options.h"
#include "app/options/view_options.h"
#include "app/outputs/annotations.h"
#include "app/strongest_lights.h"
#include "compare/result/output_parts.h"
#include "raster/frame.h"
#include "report/write_outputs.h"
#include "scene/base/expected.h"
#include "studies/commands/axes.h"
#include "studies/sweep/axis.h"
#include "studies/sweep/journal.h"

namespace gnomon::app {

// Which cells of a sweep a process makes.

/// The cells of a shard, and what the journal must know of each.
struct Plan {
  studies::Grid grid;
  std::vector<std::size_t> cells;
  std::vector<std::string> axes;
};

/// Names and values of a cell.
compare::AxisValues axis_values(const studies::Grid& grid, std::size_t cell);

/// Returns the JSON names of the axes that have no effect on a cell.
std::vector<std::string> json_names(std::vector<std::string> axes);

Plan make_plan(studies::Grid grid, studies::Shard shard);

struct SweepCommand : RunOptions {
  SceneArgument scene;
  std::string camera, folder;
  SweepOptions options;
  std::string shader_folder;
  std::vector<raster::ReplacedShader> replaced_shaders;  ///< what differs in it
  std::optional<int> runs;
  int max_lights = usual_max_lights;
  studies::Shard shard;
  std::optional<int> slurm_tasks;
  std::optional<compare::Threshold> max_error;
  FilmedMeasure asked;
  ViewListOptions views;
  Annotate annotate;
  double report_max_mb = report::default_report_max_mb;
  bool zip = false, perceptual = false, ray_tracer = false, restart = false, quiet = false;
  bool full_records = false;  ///< line_json()
};

/// Everything that the journal's lines depend on, as JSON.
std::string configuration(const SweepCommand& command, const Plan& plan, const Scene& scene);

/// What a setting is judged by from several views: that of --max-error, or what errors are.
const compare::Figure& view_measure(const SweepCommand& command);

/// How often each pass of a cell is timed: three times where nothing else is asked for, since cells are ranked; of rays no
/// further time once those made took long enough.
void set_runs(const SweepCommand& command, compare::CompareOptions& options);
int rounds_of(const SweepCommand& command);

/// What a film's objects are loaded by.
inline StageSource stage_source(const SweepCommand& command) {
  return {command.scene, command.camera, command.backend, command.shader_folder};
}

/// A cell alone: gnomon compare SCENE …, or gnomon shimmer SCENE … where its errors are flips.
std::string compare_command(const SweepCommand& command, const Plan& plan, std::size_t cell);

/// Writes the arguments of the sweep for a task of a job array, without its folder and shard.
std::string task_arguments(const SweepCommand& command);

// A sweep as a Slurm job array: one shard per task, all in one folder that the nodes share.

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
