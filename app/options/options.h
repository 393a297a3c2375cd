// The options that several subcommands share, bound to the rooms' own option structs. Each says its unit, its
// range and its default in --help. That text is made from the same numbers that the parser checks and the
// same fields that it fills. So neither can drift.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/options/map_options.h"
#include "app/outputs/heatmap.h"
#include "app/outputs/run_files.h"
#include "compare/compare.h"
#include "compare/result/engines.h"
#include "raytrace/frame.h"
#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// The scene, --allow-outside.
void add_scene(CLI::App& command, SceneArgument& scene);
/// Adds --time.
void add_scene_time(CLI::App& command, SceneArgument& scene);
void add_size(CLI::App& command, ImageSize& size);
/// --tessellate; 0: off.
void add_tessellate(CLI::App& command, int& tessellate);
void add_backend(CLI::App& command, raster::Backend& backend);
/// " --backend NAME" for what was chosen; nothing for auto.
std::string backend_argument(raster::Backend backend);
/// --shader-dir.
void add_shader_dir(CLI::App& command, std::string& folder);
/// --accel, --precision.
void add_tracer_options(CLI::App& command, raytrace::Accel& accel, raytrace::Precision& precision);
void add_precision(CLI::App& command, raytrace::Precision& precision);
/// --accel of several: all, or names with commas between.
void add_accel_list(CLI::App& command, std::vector<raytrace::Accel>& accels);
/// --heatmap.
void add_heatmap(CLI::App& command, std::optional<HeatmapOf>& heatmap);
void add_min_contribution(CLI::App& command, double& share);
/// --camera: of the scene's own cameras.
void add_camera(CLI::App& command, std::string& camera);
void add_light(CLI::App& command, std::string& light, const char* what);
/// --engine; `fallback`: what holds without it.
void add_engine(CLI::App& command, const compare::TunedEngine*& engine, const char* what,
                const char* fallback);
void add_threads(CLI::App& command, int& threads, const char* of_what);
void add_runs(CLI::App& command, std::optional<int>& runs, const char* fallback);
void add_exposure(CLI::App& command, std::optional<std::optional<double>>& exposure);
void add_seed(CLI::App& command, std::uint64_t& seed, const char* what);
/// --rays, which also takes 1e8.
void add_ray_count(CLI::App& command, std::uint64_t& rays);
/// An option of one command only: `store` parses the value and may fail.
void add_checked(CLI::App& command, const std::string& name, const char* type, const std::string& text,
                 const std::function<Expected<void>(const std::string&)>& store);
/// Left alone: each light's own number.
void add_samples(CLI::App& command, int& samples);
/// What errors are counted in and how much is good enough, as a command takes them.
struct MeasuredLimit {
  const compare::Figure*& measure;  ///< --measure
  std::optional<compare::Threshold>& limit;
};
/// Adds --measure and the limit `name` (--fail-above, --max-error); `what` happens at the limit, which is one of the measure
/// where it names none, and of no other where both are given. `filmed`: flips of films, too, which become the measure
/// where the limit is one of them.
void add_measured_limit(CLI::App& command, const std::string& name, MeasuredLimit asked,
                        std::string_view what, std::string_view fallback, bool filmed = false);
/// Returns " --measure mean"; nothing where none was asked for.
std::string measure_argument(const compare::Figure& measure);
/// --report-max-mb.
void add_report_max_mb(CLI::App& command, double& megabytes);
/// What is said of a page that grew larger than that.
std::string beside_note(double page_mb, double max_mb);
/// A file to be written; `what` says which, with its extensions.
void add_output(CLI::App& command, const char* names, std::string& path, const char* type,
                const std::string& what);
void add_json(CLI::App& command, std::string& path, const char* what);
/// --trace.
void add_trace(CLI::App& command, std::string& path);
void add_quiet(CLI::App& command, bool& quiet);
/// -v; `what` the command says more.
void add_verbose(CLI::App& command, bool& verbose, const char* what);

// What every command takes that compares a picture with the truth.

struct RunOptions {
  raster::Backend backend = raster::Backend::automatic;
  int threads = 0;                                ///< 0: all
  std::optional<std::optional<double>> exposure;  ///< an empty one: automatic; none: the scene's
  std::string trace;                              ///< file for the stages of the run; empty: none
  std::uint64_t seed = 0;                         ///< of the samples of lights with size
};
/// --backend, --threads, --exposure, --seed.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace gnomon::app
