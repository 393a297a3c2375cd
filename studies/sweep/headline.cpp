#include "studies/sweep/headline.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/result/number_text.h"
#include "compare/result/shadow_cost.h"

namespace gnomon::studies {
namespace {

HeadlineItem item(std::string title, const CellSummary& cell, const compare::Figure& measure) {
  std::string figures = compare::figure_words(cell.figures, measure);
  if (std::isfinite(cell.raster_ms)) figures += ", " + compare::milliseconds(cell.raster_ms);
  return {std::move(title), cell.cell, axes_words(cell), std::move(figures)};
}

// "Best for error" of what nobody chose; else for "wrong pixels", "mean error", "FLIP", "edge error" or "flips".
std::string error_words(const compare::Figure& measure) {
  if (&measure == &compare::wrong_and_mean()) return "error";
  if (measure.needs == compare::FigureNeeds::film) return "flips";
  return compare::measure_words(measure);
}

// Some other cell may have taken less time, but by no more than such times spread.
std::string time_title(const std::vector<CellSummary>& cells, std::size_t fastest) {
  const bool tied = std::any_of(cells.begin(), cells.end(),
                                [&](const CellSummary& c) { return c.raster_ms < cells[fastest].raster_ms; });
  return tied ? "Best for time (a tie within the spread of the times)" : "Best for time";
}

// Of what lies on the front the least product of error and time: a step along it that halves the one and
// doubles the other is neither gain nor loss. Half a pixel stands for no error.
std::size_t balanced(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  const auto product = [&](std::size_t i) {
    const double least =
        0.5 / static_cast<double>(std::max<std::uint64_t>(cells[i].figures.pixels.compared, 1));
    return std::max(cells[i].error(), least) * cells[i].raster_ms;
  };
  return *std::min_element(front.begin(), front.end(),
                           [&](std::size_t a, std::size_t b) { return product(a) < product(b); });
}

bool says_nothing_of(const CellSummary& cell) {
  return (cell.is_filmed() ? cell.figures.shimmer->receiver_steps : cell.figures.pixels.compared) == 0;
}

// Least time of those within the limit; of untimed cells the fewest texels.
const CellSummary* cheapest_within(const std::vector<CellSummary>& cells, const compare::Threshold& limit) {
  const CellSummary* best = nullptr;
  for (const CellSummary& cell : cells) {
    if (!compare::is_kept(limit, cell.lights)) continue;
    if (best == nullptr || clearly_faster(cell, *best) ||
        (!clearly_faster(*best, cell) && cell.map_texels < best->map_texels))
      best = &cell;
  }
  return best;
}

void add_limit(const std::vector<CellSummary>& cells, const compare::Threshold& limit, Headline& out) {
  const CellSummary* best = cheapest_within(cells, limit);
  out.limit_met = best != nullptr;
  if (best != nullptr)
    out.items.push_back(
        item(fmt::format("Cheapest with {}", compare::limit_words(limit)), *best, *limit.measure));
  else
    out.items.push_back({fmt::format("No cell has {}", compare::limit_words(limit)), {}, {}, {}});
}

}  // namespace

namespace {

// Why no cell is named for its time; empty where no time was taken.
std::string why_no_time(const std::vector<CellSummary>& cells) {
  if (!std::isfinite(cells.front().raster_ms)) return {};
  return share_one_drawing(cells) ? "All cells come from one drawing, so none is best for time"
                                  : "No cell is best for time, since fewer than three runs have no spread";
}

std::string_view side_of(const CellSummary& cell) {
  for (const raster::TechniqueTraits& technique : raster::all_technique_traits())
    if (technique.name == cell.technique) return compare::shadow_side(technique.technique);
  return "map";
}

// What the shadows of the cell with the least error take on both sides.
void add_costs(const CellSummary& cell, Headline& out) {
  if (!cell.costs) return;
  for (const std::string& line : compare::shadow_cost_lines(*cell.costs, side_of(cell)))
    out.items.push_back({fmt::format("Shadows of cell {}, {}", cell.cell, line), {}, {}, {}});
}

}  // namespace

std::string axes_words(const CellSummary& cell) {
  std::string out;
  for (const auto& [name, value] : cell.axes)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", axis_words(name), value_words(value));
  return out.empty() ? "the only cell" : out;
}

std::vector<std::string> Headline::lines() const {
  std::vector<std::string> out;
  for (const HeadlineItem& i : items)
    out.push_back(i.cell ? fmt::format("{}: cell {} ({}) with {}.", i.title, *i.cell, i.setting, i.figures)
                         : i.title + ".");
  return out;
}

Headline sweep_headline(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                        const std::optional<compare::Threshold>& limit) {
  Headline out;
  if (std::all_of(cells.begin(), cells.end(), says_nothing_of)) {
    out.items.push_back({"No pixel could be compared in any cell", {}, {}, {}});
    out.limit_met = !limit;
    return out;
  }
  if (limit) add_limit(cells, *limit, out);
  if (cells.size() < 2) return out;
  const compare::Figure& measure = cells.front().measure();
  const std::string error = error_words(measure);
  if (front.empty()) {
    const auto least = std::min_element(cells.begin(), cells.end(),
                                        [](const auto& a, const auto& b) { return a.error() < b.error(); });
    out.items.push_back(item("Least " + error, *least, measure));
    if (std::string why = why_no_time(cells); !why.empty()) out.items.push_back({std::move(why), {}, {}, {}});
    add_costs(*least, out);
    return out;
  }
  const std::size_t fastest = front.front(), best = front.back();
  if (fastest == best) {
    out.items.push_back(item("Best for " + error + " and for time", cells[best], measure));
    add_costs(cells[best], out);
    return out;
  }
  out.items.push_back(item("Best for " + error, cells[best], measure));
  out.items.push_back(item(time_title(cells, fastest), cells[fastest], measure));
  out.items.push_back(item("Best for both (least product of " + error + " and time)",
                           cells[balanced(cells, front)], measure));
  add_costs(cells[best], out);
  return out;
}

}  // namespace gnomon::studies
