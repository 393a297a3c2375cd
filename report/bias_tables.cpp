// Other kinds of bias, and the bias drawn with in the units of engines, as tables.
#include <fmt/core.h>

#include "compare/result/engine_units.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "report/html.h"
#include "report/light_block.h"

namespace gnomon::compare {
namespace {

std::string range_text(const BiasKind& kind) {
  const std::string from = plain_number(kind.from), unit = kind.of_slope ? "" : " world units";
  return std::isfinite(kind.to) ? fmt::format("{} to {}{}", from, plain_number(kind.to), unit)
                                : from + unit + " and more";
}

}  // namespace

std::string bias_kinds_table(const LightBlock& b) {
  if (b.light.bias_kinds.empty()) return "";
  std::string rows;
  for (const BiasKind& kind : b.light.bias_kinds)
    rows += fmt::format(
        R"(<tr><th scope="row">{}</th><td><code>{}</code></td><td class="n">{}</td><td>{}</td></tr>
)",
        kind.name, escaped(bias_arguments(kind.bias, b.in.comparison.raster.options.map)),
        percent(kind.wrong_fraction), range_text(kind));
  return R"(<h3>Which kind of bias</h3>
<p>For each kind of bias the smallest setting that is hardly worse than the best of its kind. The numbers follow from
this drawing's own map. A slope bias stands beside the automatic constant, every other kind with the constant that suits
it.</p>
)" + scroll_region("Kinds of bias of light " + std::to_string(b.index + 1),
                   R"(<table><thead><tr><th scope="col">kind</th><th scope="col">options</th><th scope="col"
class="n">wrong</th><th scope="col">hardly differs</th></tr></thead><tbody>)" +
                       rows + "</tbody></table>");
}

std::string engine_units_table(const LightBlock& b) {
  const std::vector<EngineUnit> units = engine_units(b.in.comparison, b.light);
  if (units.empty()) return "";
  std::string rows;
  for (const EngineUnit& unit : units)
    rows += fmt::format(
        R"(<tr><th scope="row">{}</th><td>{}</td><td class="n">{}</td><td>{}</td></tr>
)",
        unit.engine, unit.setting, unit.value ? plain_number(*unit.value) : std::string("\u2013"),
        escaped(unit.formula));
  return R"(<details><summary>This bias in the units of engines</summary>
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
