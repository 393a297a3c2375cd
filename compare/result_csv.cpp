// result.csv: one row per light, one column per number of result.json, with the unit in the column's name.
// RFC 4180: fields that hold a comma, a quote or a line break are quoted; lines end with CR LF. Missing is
// empty.
#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "compare/csv_field.h"
#include "compare/filter_parameters.h"
#include "compare/option_names.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"

namespace gnomon::compare {
namespace {

using Row = std::vector<std::pair<std::string, std::string>>;  // column name, value

std::string number(double v) {
  return std::isfinite(v) ? fmt::format("{}", v) : std::string();
}
std::string median(const Times& t) {
  return t.runs.empty() ? std::string() : number(t.median());
}

void add_setting(Row& row, const Comparison& c, const LightComparison& light) {
  const raster::MapOptions& map = c.raster.options.map;
  const raster::LightRecord& record = drawn_record(c, light);
  row.emplace_back("scene", csv_name(c.world->scene->name));
  row.emplace_back("light", csv_name(light_of(c, light).name));
  row.emplace_back("light_type", light_type_name(light_of(c, light).type));
  row.emplace_back("width_pixels", fmt::to_string(c.raster.options.size.width));
  row.emplace_back("height_pixels", fmt::to_string(c.raster.options.size.height));
  row.emplace_back("technique", technique_name(map.technique));
  row.emplace_back("filter", filter_kind(map));
  row.emplace_back("map_size_texels", fmt::to_string(record.map.view.size));
  row.emplace_back("depth_format", depth_format_name(record.map.format));
  row.emplace_back("bias_constant_world", number(record.bias_constant_world));
  row.emplace_back("bias_slope", number(map.bias.slope));
  row.emplace_back("bias_normal_offset_texels", number(map.bias.normal_offset_texels));
  row.emplace_back("bias_receiver_plane", map.bias.receiver_plane ? "true" : "false");
  row.emplace_back("bias_adaptive", map.bias.adaptive ? "true" : "false");
  row.emplace_back("texel_world_median", number(light.texel_world[1]));
}

void add_errors(Row& row, const LightComparison& light) {
  const auto count = [&row](std::string name, std::uint64_t n) {
    row.emplace_back(std::move(name), fmt::to_string(n));
  };
  count("total_pixels", light.pixels.total);
  count("background_pixels", light.pixels.background);
  count("facing_away_pixels", light.pixels.facing_away);
  count("silhouette_pixels", light.pixels.silhouette);
  count("uncertain_pixels", light.pixels.uncertain);
  count("compared_pixels", light.pixels.compared);
  count("wrong_pixels", light.error.wrong);
  row.emplace_back("wrong_fraction", number(light.error.wrong_fraction));
  count("false_shadow_pixels", light.error.false_shadow);
  count("missed_shadow_pixels", light.error.missed_shadow);
  row.emplace_back("mean_absolute", number(light.error.mean_absolute));
  row.emplace_back("rms", number(light.error.rms));
  row.emplace_back("flip", number(light.error.flip));
  row.emplace_back("ssim", number(light.error.ssim));
  for (std::size_t k = 0; k < class_count; ++k)
    count(fmt::format("{}_pixels", label_name(static_cast<Label>(k + 1))), light.classes[k]);
  count("right_by_accident_shadowed_pixels", light.accidents.shadowed);
  count("right_by_accident_lit_pixels", light.accidents.lit);
  for (std::size_t k = 0; k < cause_count; ++k) {
    const auto cause = cause_name(static_cast<Cause>(k));
    row.emplace_back(fmt::format("budget_{}_signed", cause), number(light.budget[k].signed_mean));
    row.emplace_back(fmt::format("budget_{}_absolute", cause), number(light.budget[k].absolute_mean));
    row.emplace_back(fmt::format("budget_{}_darkened", cause), number(light.budget[k].darkened()));
    row.emplace_back(fmt::format("budget_{}_lightened", cause), number(light.budget[k].lightened()));
    count(fmt::format("budget_{}_false_shadow_pixels", cause), light.budget[k].false_shadow);
    count(fmt::format("budget_{}_missed_shadow_pixels", cause), light.budget[k].missed_shadow);
  }
  row.emplace_back("edge_mean_texels", number(light.edges.mean_texels));
  row.emplace_back("edge_rms_texels", number(light.edges.rms_texels));
  row.emplace_back("edge_rms_pixels", number(light.edges.rms_pixels));
  row.emplace_back("edge_mean_absolute_texels", number(light.edges.mean_absolute_texels));
  row.emplace_back("edge_mean_world", number(light.edges.mean_world));
  row.emplace_back("edge_mean_absolute_world", number(light.edges.mean_absolute_world));
  row.emplace_back("edge_rms_world", number(light.edges.rms_world));
  row.emplace_back("detachment_mean_world", number(light.detachment.mean_world));
  row.emplace_back("detachment_max_world", number(light.detachment.max_world));
  row.emplace_back("detachment_rms_world", number(light.detachment.rms_world));
  row.emplace_back("best_bias_world", number(light.best_bias.constant_world));
  row.emplace_back("best_bias_wrong_fraction", number(light.best_bias.wrong_fraction));
  row.emplace_back("best_bias_feasible", light.best_bias.feasible ? "true" : "false");
}

void add_costs(Row& row, const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& drawn = drawn_record(c, light);
  const raytrace::LightTruth& truth = true_record(c, light);
  row.emplace_back("map_pass_ms", median(drawn.map_pass));
  row.emplace_back("shade_pass_ms", median(drawn.shade_pass));
  row.emplace_back("shadow_rays_ms", median(truth.shadow_rays));
  row.emplace_back("exact_shadows_ms", median(truth.exact_times()));
  row.emplace_back("classify_ms", median(light.classify));
  row.emplace_back("shadow_rays", fmt::to_string(truth.rays));
  row.emplace_back("soft_shadow_rays", fmt::to_string(truth.soft_rays));
  row.emplace_back("soft_shadow_rays_asked", fmt::to_string(truth.soft_rays_asked));
}

std::string line(const Row& row, bool names) {
  std::string text;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) text += ',';
    text += csv_field(names ? row[i].first : row[i].second);
  }
  return text + "\r\n";
}

}  // namespace

std::string result_csv(const Comparison& c) {
  std::string text;
  for (const LightComparison& light : c.lights) {
    Row row;
    add_setting(row, c, light);
    add_errors(row, light);
    add_costs(row, c, light);
    if (text.empty()) text = line(row, true);
    text += line(row, false);
  }
  return text;
}

}  // namespace gnomon::compare
