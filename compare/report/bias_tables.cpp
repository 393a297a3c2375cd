// Other kinds of bias, and the bias drawn with in the units of engines, as tables.
#include <fmt/format.h>

#include "compare/engine_units.h"
#include "compare/option_names.h"
#include "compare/output_parts.h"
#include "compare/report/html.h"
#include "compare/report/light_block.h"

namespace gnomon::compare {
namespace {

std::string range_text(const BiasKind& kind) {
  const std::string from = plain_number(kind.from) + (kind.of_slope ? "" : " world units");
  return std::isfinite(kind.to) ? fmt::format("{} to {}", from, plain_number(kind.to)) : from + " and more";
}

}  // namespace

std::string bias_kinds_table(const LightBlock& b) {
  if (b.light.bias_kinds.empty()) return "";
  std::string rows;
  for (const BiasKind& kind : b.light.bias_kinds)
    rows += fmt::format(
        R"(<tr><th scope="row">{}</th><td><code>{}</code></td><td class="n">{}</td><td>{}</td></tr>
)",
        kind.name, escaped(bias_arguments(kind.bias)), percent(kind.wrong_fraction), range_text(kind));
  return R"(<h3>Which kind of bias</h3>
<p>Each kind at its smallest setting that is hardly wrong more often than its best, as this map answers without another
drawing: the slope bias beside the automatic constant, the others with the constant that suits them.</p>
)" + scroll_region("Kinds of bias of light " + std::to_string(b.index + 1),
                   R"(<table><thead><tr><th scope="col">kind</th><th scope="col">options</th><th scope="col"
class="n">wrong</th><th scope="col">hardly differs</th></tr></thead><tbody>)" +
                       rows + "</tbody></table>");
}

std::string engine_units_table(const LightBlock& b) {
  const Comparison& c = b.in.comparison;
  const raster::LightRecord& record = drawn_record(c, b.light);
  if (!compares_depths(c.raster.options.map.technique)) return "";
  std::string rows;
  for (const EngineUnit& unit : engine_units(c.raster.options.map.bias, record.bias_constant_world,
                                             c.world->scene->lights[b.light.light].type, record, *c.world))
    rows += fmt::format(
        R"(<tr><th scope="row">{}</th><td>{}</td><td class="n">{}</td><td>{}</td></tr>
)",
        unit.engine, unit.setting, unit.value ? plain_number(*unit.value) : std::string("\u2013"),
        escaped(unit.formula));
  return R"(<details><summary>The bias drawn with, in the units of engines</summary>
<p>For a light whose map has this size, width and depths; docs/engine-units.md explains the symbols.</p>
)" +
         scroll_region(
             "Engine units of light " + std::to_string(b.index + 1),
             R"(<table><thead><tr><th scope="col">engine</th><th scope="col">setting</th><th scope="col"
class="n">value</th><th scope="col">formula</th></tr></thead><tbody>)" +
                 rows + "</tbody></table>") +
         "</details>\n";
}

}  // namespace gnomon::compare
