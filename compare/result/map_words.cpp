#include "compare/result/map_words.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/filter_probe.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

std::string bias_words(const raster::LightRecord& record, double texel_world) {
  return ", bias " + constant_text(record, texel_world);
}

}  // namespace

std::string stored_text(const raster::LightRecord& record) {
  const bool is_foreign = record.foreign && record.foreign->test;
  return std::string(is_foreign ? record.foreign->stores : depth_format_name(record.map.format));
}

std::string two_lengths(const std::array<raster::UnitAt, 2>& units, double stored) {
  constexpr double hardly = 1.05;  // of lengths that are said with three digits as one
  const auto& [near, far] = units;
  if (!(far.world > hardly * near.world) || stored == 0.0) return {};
  return fmt::format("{} at {:.3g} from the light, {:.3g} at {:.3g}",
                     with_noun(fmt::format("{:.3g}", stored * near.world), "world unit"), near.distance,
                     stored * far.world, far.distance);
}

std::string constant_text(const raster::LightRecord& record, double texel_world) {
  const double world = record.bias_constant_world;
  if (record.foreign && record.foreign->test) {
    const double stored = world / record.foreign->unit_world;
    if (const std::string two = two_lengths(record.foreign->units, stored); !two.empty())
      return fmt::format("{} of stored depth ({})", plain_number(stored), two);
  }
  if (!(texel_world > 0.0)) return plain_number(world);
  return fmt::format("{} ({}; a texel is {} wide)", plain_number(world), texels_text(world / texel_world),
                     plain_number(texel_world));
}

std::string map_details(const Comparison& c, const LightComparison* light) {
  const raster::MapOptions& map = c.raster.options.map;
  if (!compares_depths(map.technique)) return {};
  const raster::LightRecord& record = drawn_record(c, light != nullptr ? *light : c.lights.front());
  const std::string text = ", " + stored_text(record);
  if (!draws_bias(c)) return text + ", shader of --shader-dir";
  return text + (light != nullptr ? bias_words(record, light->bias_texel_world) : std::string()) +
         beside_constant(map);
}

std::vector<const raster::MapSetting*> filter_settings(const raster::RasterFrame& drawn) {
  const auto& foreign = drawn.lights.front().foreign;
  std::vector<const raster::MapSetting*> out;
  for (const raster::MapSetting& setting : raster::map_settings()) {
    if (setting.group != raster::SettingGroup::filter || !raster::reads(drawn.options.map, setting)) continue;
    if (!foreign || std::ranges::count(foreign->said, setting.name) > 0) out.push_back(&setting);
  }
  return out;
}

std::string_view shown_filter_kind(const raster::RasterFrame& drawn) {
  const raster::MapOptions& map = drawn.options.map;
  const bool unsaid = drawn.lights.front().foreign && raster::has_kernel(map.technique);
  return unsaid ? "pcf" : filter_kind(map);
}

std::string filter_text(const raster::RasterFrame& drawn) {
  if (drawn.lights.empty() || shown_filter_kind(drawn) == "none") return {};
  std::string text(shown_filter_kind(drawn));
  for (const raster::MapSetting* setting : filter_settings(drawn))
    // Neither the kind nor how the receiver's depth is taken is a parameter.
    if (setting->name != "filter-kernel" && setting->name != "filter-plane")
      text += ", " + setting_words(*setting, drawn.options.map);
  if (const auto& foreign = drawn.lights.front().foreign)
    for (const auto& [key, words, value] : foreign->numbers)
      text += fmt::format(", {} {}", words, plain_number(value));
  return text;
}

}  // namespace gnomon::compare
