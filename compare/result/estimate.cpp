#include "compare/result/estimate.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/shadow_cost.h"
#include "raster/technique_traits.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/read_file.h"

namespace gnomon::compare {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double milliseconds_of(std::uint64_t count, double per_second) {
  if (count == 0) return 0.0;
  return per_second > 0.0 ? 1000.0 * static_cast<double>(count) / per_second : unknown;
}

/// What stands for the map takes: of a map its lookups, of few rays the rays and the denoiser's taps. What the hybrid and izb
/// read is not counted.
double looked_up(const Rates& rates, const Comparison& c, const LightComparison& light) {
  const auto& external = drawn_record(c, light).external;
  if (external && raster::samples_rays(c.raster.options.map.technique))
    return milliseconds_of(external->rays, rates.rays) + milliseconds_of(external->taps, rates.taps);
  return light.lookups && !external ? milliseconds_of(*light.lookups, rates.lookups) : unknown;
}

std::string sides_words(const EstimatedSides& sides, std::string_view by) {
  const auto side = [](double ms) { return std::isnan(ms) ? std::string("not known") : milliseconds(ms); };
  return fmt::format("{} by the {}, {} by rays", side(sides.map), by, side(sides.rays));
}

}  // namespace

Expected<Rates> read_rates(const std::string& file) {
  auto text = read_file(file);
  if (!text) return fail(text.error());
  const auto document = parse_json(std::move(*text), file);
  if (!document) return fail(document.error());
  JsonErrors errors{*document};
  const JsonObject json(JsonNode(errors, document->root, ""),
                        {"schema", "name", "source", "texels_per_second", "lookups_per_second",
                         "rays_per_second", "taps_per_second"});
  if (const auto schema = json.require("schema"))
    if (schema->as_string() != rates_schema) schema->wrong("unknown schema", std::string(rates_schema));
  Rates rates;
  if (const auto name = json.require("name")) rates.name = name->as_string();
  rates.source = json.string("source");
  constexpr NumberRange range{1.0, 1e18};
  rates.texels = json.number("texels_per_second", 0.0, range);
  rates.lookups = json.number("lookups_per_second", 0.0, range);
  rates.rays = json.number("rays_per_second", 0.0, range);
  rates.taps = json.number("taps_per_second", 0.0, range);
  if (errors.first) return fail(std::move(*errors.first));
  return rates;
}

EstimatedSides estimated_sides(const Comparison& c, const LightComparison& light, bool map_is_drawn) {
  const Rates& rates = *c.rates;
  const double drawn = map_is_drawn ? milliseconds_of(drawn_record(c, light).map_texels, rates.texels) : 0.0;
  return {drawn + looked_up(rates, c, light),
          milliseconds_of(true_record(c, light).exact_rays(), rates.rays)};
}

std::vector<std::string> estimate_lines(const Comparison& c, const LightComparison& light) {
  if (!c.rates) return {};
  const std::string_view by = shadow_side(c.raster.options.map.technique);
  std::vector<std::string> lines{fmt::format("on {}, estimated from the counts:", c.rates->name)};
  for (const bool moves : {false, true})
    lines.push_back(fmt::format("{}: {}", moves ? "light or camera moves" : "nothing moves",
                                sides_words(estimated_sides(c, light, moves), by)));
  return lines;
}

}  // namespace gnomon::compare
