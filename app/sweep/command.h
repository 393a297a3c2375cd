// What gnomon sweep was asked for, and how it is said again: to the journal, to compare, to a job array.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/sweep/axes.h"
#include "app/sweep/plan.h"
#include "compare/outputs.h"
#include "compare/sweep/journal.h"
#include "raster/frame.h"

namespace gnomon::app {

struct SweepCommand {
  SceneArgument scene;
  std::string camera, folder;
  SweepOptions options;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
  std::vector<raster::ReplacedShader> replaced_shaders;  ///< what differs in it
  std::optional<int> runs;
  std::optional<std::optional<double>> exposure;
  std::uint64_t seed = 0;
  int threads = 0;
  compare::Shard shard;
  std::optional<int> slurm_tasks;
  std::optional<compare::Threshold> max_error;
  double report_max_mb = compare::default_report_max_mb;
  bool zip = false, perceptual = false, ray_tracer = false, restart = false, quiet = false;
};

/// Everything that the journal's lines hang on, as JSON.
std::string configuration(const SweepCommand& command, const Plan& plan, const Scene& scene);

/// A cell alone.
std::string compare_command(const SweepCommand& command, const Plan& plan, std::size_t cell);

/// The same sweep for a task of a job array, without its folder and shard.
std::string task_arguments(const SweepCommand& command);

}  // namespace gnomon::app
