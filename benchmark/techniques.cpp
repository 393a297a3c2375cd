#include "benchmark/techniques.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/shadow_cost.h"
#include "raster/technique_traits.h"
#include "scene/base/expected.h"
#include "scene/base/parallel.h"

namespace gnomon::bench {
namespace {

compare::Setting setting_for(const Scene& scene, const raster::RasterOptions& raster) {
  compare::Setting setting;
  setting.raster = raster;
  setting.raytrace.size = raster.size;
  setting.raster.shadow_cost = true;
  setting.raytrace.runs = std::max(1, raster.runs);
  setting.raytrace.warm_up = true;
  setting.raytrace.picture = false;
  setting.camera = scene.camera;
  setting.lights = scene.lights;
  for (std::uint32_t i = 0; i < setting.lights.size(); ++i) setting.compared.push_back(i);
  return setting;
}

std::string main_label(const std::array<double, compare::class_count>& errors) {
  const auto most = std::max_element(errors.begin(), errors.end());
  if (!(*most > 0.0)) return {};
  return std::string(label_name(static_cast<compare::Label>(most - errors.begin() + 1)));
}

TechniqueRow measure(const std::string& technique, const compare::Comparison& comparison) {
  TechniqueRow row;
  row.technique = technique;
  double absolute = 0.0;
  std::uint64_t lookups = 0;
  std::array<double, compare::class_count> errors{};
  for (const compare::LightComparison& light : comparison.lights) {
    row.compared += light.pixels.compared;
    row.wrong += light.error.wrong;
    absolute += light.error.mean_absolute * static_cast<double>(light.pixels.compared);
    for (std::size_t k = 0; k < errors.size(); ++k)
      errors[k] += light.class_errors[k] * static_cast<double>(light.pixels.compared);
    const raster::LightRecord& record = comparison.raster.lights[light.record];
    row.map_ms += record.map_pass.median();
    row.lookups += compare::shadow_lookups(record);
    row.unshadowed_ms += record.unshadowed_pass.median();
    lookups += light.lookups.value_or(0);
  }
  if (row.compared > 0) {
    row.lookups_per_pixel = static_cast<double>(lookups) / static_cast<double>(row.compared);
    row.mean_absolute = absolute / static_cast<double>(row.compared);
  }
  row.texels = comparison.raster.map_texels;
  row.bytes = comparison.raster.map_bytes;
  row.main_label = main_label(errors);
  return row;
}

void add_rays(const compare::Comparison& comparison, TechniqueTable& table) {
  table.rays_ms = 0.0;
  for (const raytrace::LightTruth& light : comparison.raytraced.lights)
    table.rays_ms += light.exact_times().median();
  table.tree_ms = comparison.raytraced.structure.median();
}

double shadows_ms(const TechniqueRow& row) {
  return row.map_ms + row.lookups.median;
}

// A column's number, or the interval where the runs do not tell the lookups from nothing.
std::string lookups_ms_text(const TechniqueRow& row, double besides_ms = 0.0) {
  TimeDifference sum = row.lookups;
  if (!sum.timed()) return "–";
  sum += besides_ms;
  return sum.told ? fmt::format("{:.1f}", sum.median) : fmt::format("{:.0f} to {:.0f}", sum.low, sum.high);
}

std::string lookups_text(const TechniqueRow& row) {
  return row.lookups_per_pixel > 0.0 ? fmt::format("{:.3g}", row.lookups_per_pixel) : std::string("–");
}

double percent(const TechniqueRow& row) {
  return 100.0 * static_cast<double>(row.wrong) / static_cast<double>(row.compared);
}

std::string mebibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

std::string markdown_row(const TechniqueRow& row) {
  if (!row.refused.empty())
    return fmt::format("| `{}` | {} | | | | | | | | | | |\n", row.technique, row.refused);
  return fmt::format("| `{}` | {} | {:.3f} | {} | {:.5f} | {:.1f} | {} | {} | {:.1f} | {:.2f} | {} | {} |\n",
                     row.technique, row.wrong, percent(row), row.main_label, row.mean_absolute, row.map_ms,
                     lookups_ms_text(row), lookups_ms_text(row, row.map_ms), row.unshadowed_ms,
                     static_cast<double>(row.texels) * 1e-6, lookups_text(row), mebibytes(row.bytes));
}

}  // namespace

Expected<TechniqueTable> bench_techniques(Scene& scene, const World& world, raster::Renderer& renderer,
                                          const raster::RasterOptions& base, const Progress& progress) {
  studies::Engine engine(scene, world, renderer, false);
  TechniqueTable table{scene.name, base.size, base.map.size, {}};
  const auto techniques = raster::all_technique_traits();
  for (const raster::TechniqueTraits& traits : techniques) {
    const std::string name(traits.name);
    progress(name, static_cast<double>(table.rows.size()) / static_cast<double>(techniques.size()));
    compare::Setting setting = setting_for(scene, base);
    setting.raster.map.technique = traits.technique;
    setting.raster.map.bias = raster::default_bias(setting.raster.map);
    const auto comparison = engine.compare(setting);
    if (comparison) {
      table.rows.push_back(measure(name, **comparison));
      if (table.rows.back().compared == 0)
        return fail(ErrorKind::bad_input,
                    fmt::format("{}: no pixel can be compared, so no technique can be measured", scene.name));
      add_rays(**comparison, table);
    } else if (comparison.error().kind == ErrorKind::usage) {
      TechniqueRow& row = table.rows.emplace_back();
      row.technique = name;
      row.refused = comparison.error().reason;
    } else {
      return fail(comparison.error());
    }
  }
  return table;
}

std::string markdown(std::span<const TechniqueTable> tables, const std::string& command) {
  std::string text = fmt::format(
      "# Every technique on the same pixels\n\nMade by the program itself: `{}`. Wrong pixels are compared "
      "pixels whose drawn visibility is more than one half from the ray-traced one; mean error is the mean "
      "of "
      "that difference. Every technique has its default parameters.\n\nShadow cost stands against shadow "
      "cost: "
      "the map, and what looking it up adds to the same shading without shadows (last of the times, the "
      "picture's own), against the rays. Under a light that stands still the lookups alone remain on the "
      "map's side; where the runs do not tell them from nothing, their interval stands. Both sides are timed "
      "warm, as often as each other. {}\n",
      command, compare::software_note);
  for (const TechniqueTable& table : tables) {
    text += fmt::format(
        "\n## {}\n\n{} x {} pixels, maps of {}² texels. The exact shadows of the same pixels take {:.1f} "
        "ms, where casters move {:.1f} ms with their tree.\n\n| technique | wrong | % | "
        "mostly | mean error | map ms | lookups ms | shadows ms | picture ms | Mtexels | lookups a pixel | "
        "MiB |\n|---|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        one_line(table.scene), table.size.width, table.size.height, table.map_size, table.rays_ms,
        table.rays_ms + table.tree_ms);
    for (const TechniqueRow& row : table.rows) text += markdown_row(row);
  }
  return text;
}

std::string text_table(const TechniqueTable& table) {
  std::string text = fmt::format(
      "{}: {}x{} pixels, maps of {} texels; exact shadows take {:.1f} ms, where casters move {:.1f} ms with "
      "their tree\n"
      "{:<13}{:>9}{:>8} {:<14}{:>9}{:>8}{:>9}{:>8}{:>8}\n",
      one_line(table.scene), table.size.width, table.size.height, table.map_size, table.rays_ms,
      table.rays_ms + table.tree_ms, "technique", "wrong", "%", "mostly", "error", "map ms", "lookups",
      "a pixel", "MiB");
  for (const TechniqueRow& row : table.rows) {
    text += row.refused.empty()
                ? fmt::format("{:<13}{:>9}{:>8.3f} {:<14}{:>9.5f}{:>8.1f}{:>9}{:>8}{:>8}\n", row.technique,
                              row.wrong, percent(row), row.main_label, row.mean_absolute, row.map_ms,
                              lookups_ms_text(row), lookups_text(row), mebibytes(row.bytes))
                : fmt::format("{:<13} {}\n", row.technique, row.refused);
  }
  return text;
}

std::vector<BenchRow> bench_rows(const TechniqueTable& table) {
  const int threads = threads_in_use();
  std::vector<BenchRow> rows;
  for (const TechniqueRow& row : table.rows) {
    if (!row.refused.empty()) continue;
    const BenchPeer rays{"exact shadows", table.rays_ms};
    rows.push_back(
        {row.technique + " map and lookups", table.scene, threads, shadows_ms(row), "ms", false, rays});
    rows.push_back({row.technique + " wrong pixels", table.scene, threads, static_cast<double>(row.wrong),
                    "pixels", false});
  }
  return rows;
}

}  // namespace gnomon::bench
