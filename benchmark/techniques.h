// The shadow techniques side by side: what each gets wrong and what it costs, at its default parameters.
#pragma once

#include <string>
#include <vector>

#include "benchmark/row.h"
#include "raster/renderer.h"
#include "scene/base/time_difference.h"
#include "scene/image.h"
#include "studies/sweep/engine.h"

namespace gnomon::bench {

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
  double tree_ms = 0.0;  ///< what casters that move have the rays build anew
};

/// Draws with every technique and the options of `base`.
Expected<TechniqueTable> bench_techniques(Scene& scene, const World& world, raster::Renderer& renderer,
                                          const raster::RasterOptions& base, const Progress& progress);

/// Writes the tables as Markdown; the page says how it was made.
std::string markdown(std::span<const TechniqueTable> tables, const std::string& command);
/// For a terminal, 80 columns.
std::string text_table(const TechniqueTable& table);
std::vector<BenchRow> bench_rows(const TechniqueTable& table);

}  // namespace gnomon::bench
