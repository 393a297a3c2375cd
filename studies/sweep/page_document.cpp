// What the sweep's page shows, as one document (page/src/sweep_document.ts): the sweep's own settings, its cells over all
// lights together, those worth having, and the ray tracer's points. The cells' pictures are parts of the page's data, or
// files beside the page (cell_files.h).
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "compare/result/shadow_cost.h"
#include "report/page.h"
#include "studies/sweep/headline.h"
#include "studies/sweep/page.h"

namespace gnomon::studies {
namespace {

using compare::Figure;
using compare::Json;
using compare::number;

Json range_json(const TimeDifference& ms) {
  if (!ms.timed()) return Json::array();
  return {number(ms.low), number(ms.median), number(ms.high)};
}

/// By situation, what the map's side takes, and the rays'; flat, for the page without scripts is a table of them.
void add_costs(const std::optional<compare::ShadowCosts>& costs, Json& cell) {
  for (const compare::ShadowSituation& one : compare::shadow_situations()) {
    const compare::ShadowCosts::Sides sides = costs ? *costs.*one.sides : compare::ShadowCosts::Sides();
    cell[fmt::format("{}_map_ms", one.key)] = range_json(sides.map);
    cell[fmt::format("{}_rays_ms", one.key)] = range_json(sides.rays);
  }
}

/// The least and the most load of the machine; null where it is not known.
Json load_range(const std::vector<CellSummary>& cells) {
  std::vector<double> known;
  for (const CellSummary& cell : cells)
    if (std::isfinite(cell.load)) known.push_back(cell.load);
  if (known.empty()) return nullptr;
  const auto [least, most] = std::minmax_element(known.begin(), known.end());
  return {number(*least), number(*most)};
}

/// "1.2 %", "1.6 texels"; of films "0.012 flips per receiver and second".
std::string error_text(const CellSummary& cell) {
  const Figure& measure = cell.measure();
  const std::string text = compare::figure_text(measure, cell.error());
  return cell.is_filmed() ? fmt::format(fmt::runtime(measure.measure.said), text) : text;
}

bool in_tables(const Figure& figure) {
  return figure.table == Figure::Table::sweep;
}

/// The columns of figures; what only some sweeps make has one where the cell has it.
Json columns_json(const CellSummary& first) {
  Json columns = Json::array();
  for (const Figure& figure : compare::figures()) {
    const bool always =
        figure.needs == compare::FigureNeeds::nothing || figure.needs == compare::FigureNeeds::edges;
    if (!in_tables(figure) || (!always && std::isnan(figure.of(first.figures)))) continue;
    columns.push_back({{"key", figure.name()},
                       {"head", compare::figure_head(figure)},
                       {"form", compare::form_name(figure.form())}});
  }
  return columns;
}

Json cell_json(const SweepPageInput& in, const CellSummary& cell, bool on_front) {
  Json values = Json::array(), shown = Json::array();
  for (const auto& [name, value] : cell.axes) values.push_back(value), shown.push_back(value_words(value));
  const auto pictures = in.pictures.find(cell.cell);
  const bool is_pictured = pictures != in.pictures.end();
  Json json{{"cell", cell.cell},
            {"values", std::move(values)},
            {"shown", std::move(shown)},
            {"no_effect", cell.no_effect},
            {"front", on_front},
            {"command", cell.command},
            {"technique", cell.technique},
            {"compared", cell.figures.pixels.compared},
            {"error", number(cell.error())},
            {"error_words", error_text(cell)},
            {"mostly", label_words_of(cell.main_label)},
            {"map_size", number(cell.map_size)},
            {"map_texels", cell.map_texels},
            {"map_bytes", cell.map_bytes},
            {"raster_ms", number(cell.raster_ms)},
            {"rays_ms", number(cell.rays_ms)},
            {"exact_shadow_ms", number(cell.exact_shadow_ms)},
            {"derived", cell.derived},
            {"pictures", is_pictured && !pictures->second.data.empty()},
            {"drawn", is_pictured && !pictures->second.drawing.empty()}};
  add_costs(cell.costs, json);
  json.update(compare::named_figures(cell.figures, in_tables));
  return json;
}

/// What the page's errors are: how charts and captions call them, and whether they are shares.
Json measure_json(const Figure& measure) {
  const std::string words = &measure == &compare::wrong_and_mean()
                                ? "the larger of wrong pixels and mean error"
                            : measure.measure.by_halves ? std::string(measure.mark.words)
                                                        : compare::figure_head(measure);
  return {{"name", measure.measure.name},
          {"words", words},
          {"shares", measure.form() == compare::FigureForm::percent}};
}

Json headline_json(const Headline& headline) {
  Json items = Json::array();
  for (const HeadlineItem& item : headline.items)
    items.push_back({{"title", item.title},
                     {"cell", item.cell ? Json(*item.cell) : Json(nullptr)},
                     {"setting", item.setting},
                     {"figures", item.figures}});
  return items;
}

}  // namespace

std::string sweep_document(const SweepPageInput& in) {
  const std::vector<std::size_t> front = pareto_front(in.cells);
  Json axes = Json::array(), cells = Json::array(), best = Json::array();
  for (const auto& [name, value] : in.cells.front().axes) axes.push_back(name);
  for (const std::size_t i : front) best.push_back(in.cells[i].cell);
  for (std::size_t i = 0; i < in.cells.size(); ++i)
    cells.push_back(cell_json(in, in.cells[i], std::find(front.begin(), front.end(), i) != front.end()));
  return Json{{"version", compare::program_version()},
              {"configuration", Json::parse(in.header.configuration)},
              {"measure", measure_json(in.cells.front().measure())},
              {"axes", std::move(axes)},
              {"columns", columns_json(in.cells.front())},
              {"headline", headline_json(sweep_headline(in.cells, front, in.limit))},
              {"front", std::move(best)},
              {"situations", report::situation_facts(true)},
              {"load", load_range(in.cells)},
              {"rays", Json::parse(ray_points_json(in.rays)).at("points")},
              {"reference_samples", reference_samples},
              {"cells", std::move(cells)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gnomon::studies
