// What gnomon sweep was asked for, and how it is said again: to the journal, to compare, to a job array.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run_options.h"
#include "app/shimmer_options.h"
#include "app/strongest_lights.h"
#include "app/sweep/axes.h"
#include "app/sweep/plan.h"
#include "raster/frame.h"
#include "report/write_outputs.h"
#include "studies/sweep/journal.h"

namespace gnomon::app {

struct SweepCommand : RunOptions {
  SceneArgument scene;
  std::string camera, folder;
  SweepOptions options;
  std::string shader_folder;
  std::vector<raster::ReplacedShader> replaced_shaders;  ///< what differs in it
  std::optional<int> runs;
  int max_lights = usual_max_lights;
  compare::Shard shard;
  std::optional<int> slurm_tasks;
  std::optional<compare::Threshold> max_error;
  MetricOptions metric;
  double report_max_mb = compare::default_report_max_mb;
  bool zip = false, perceptual = false, ray_tracer = false, restart = false, quiet = false;
};

/// Everything that the journal's lines hang on, as JSON.
std::string configuration(const SweepCommand& command, const Plan& plan, const Scene& scene);

/// How often each pass of a cell is timed: three times where nothing else is asked for, since cells are ranked; of rays no
/// further time once those made took long enough.
void set_runs(const SweepCommand& command, compare::CompareOptions& options);

/// A cell alone: gnomon compare SCENE …, or gnomon shimmer SCENE … where its errors are flips.
std::string compare_command(const SweepCommand& command, const Plan& plan, std::size_t cell);

/// The same sweep for a task of a job array, without its folder and shard.
std::string task_arguments(const SweepCommand& command);

}  // namespace gnomon::app
