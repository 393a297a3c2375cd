// The shadow techniques side by side: what each gets wrong and what it costs, at its default parameters.
#pragma once

#include <string>
#include <vector>

#include "app/bench/row.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/session.h"
#include "scene/image.h"
#include "studies/sweep/engine.h"

namespace gnomon::app {

/// One technique on one scene, all lights together.
struct TechniqueRow {
  std::string technique;
  std::string refused;  ///< why it cannot be used here; the rest is then empty
  std::uint64_t compared = 0, wrong = 0;
  double mean_absolute = 0.0;  ///< of V6 - V0 over compared pixels
  /// Medians, summed over lights: the map, what looking it up adds to the shading, and the shading without.
  double map_ms = 0.0, unshadowed_ms = 0.0;
  TimeDifference lookups;
  double lookups_per_pixel = 0.0;  ///< 0: none are counted
  std::uint64_t texels = 0, bytes = 0;
  std::string main_label;  ///< of most of the error
};

struct TechniqueTable {
  std::string scene;
  ImageSize size;
  int map_size = 0;
  std::vector<TechniqueRow> rows;
  /// Exact shadows of the same pixels: the lights' structures and the rays, which are what the truth costs.
  double rays_ms = 0.0;
};

/// Every technique of technique_names() with the options of `base`.
Expected<TechniqueTable> bench_techniques(const LoadedScene& loaded, raster::Backend backend,
                                          const raster::RasterOptions& base,
                                          const std::function<void(const std::string&, double)>& progress);

/// Every scene's table on stdout, and as a page (Markdown) and rows where files are named.
struct TechniqueBench {
  std::vector<std::string> scenes;
  SceneArgument how;  ///< they are loaded
  raster::RasterOptions raster;
  std::string page, json;    ///< files to write; empty: none
  std::string command_line;  ///< for the page
  bool quiet = false;
};
Expected<void> run_technique_bench(const TechniqueBench& bench, Console& console);

/// As Markdown; the page says how it was made.
std::string markdown(std::span<const TechniqueTable> tables, const std::string& command);
/// For a terminal, 80 columns.
std::string text_table(const TechniqueTable& table);
std::vector<BenchRow> bench_rows(const TechniqueTable& table);

// The tuner against a full grid on real milliseconds: does its answer cost no more than the grid's best?

struct TuneBench {
  std::vector<std::string> scenes, techniques;  ///< techniques empty: all
  SceneArgument how;                            ///< the scenes are loaded
  double max_error = 0.01;                      ///< share of wrong pixels, the tuner's goal
  ImageSize size = quick_picture;
  int runs = 9;      ///< drawings in turn: of the tuner's finalists, and of its answer and the grid's best
  std::string json;  ///< file to write; empty: none
  bool quiet = false;
};

/// A line per scene on stdout. Errors are those of loading, drawing and writing.
Expected<void> run_tune_bench(const TuneBench& bench, Console& console);

// The whole benchmark is a program of its own, for it holds Embree, which the user's own program never does.

struct WholeBench {
  int runs = 0;  ///< 0: as it likes
  std::string json;
  std::string size;  ///< WxH
};

/// Becomes gnomon_bench, found beside this program or in the build's tests. Returns only to say why not.
Expected<ExitCode> run_whole_bench(const WholeBench& bench);

}  // namespace gnomon::app
