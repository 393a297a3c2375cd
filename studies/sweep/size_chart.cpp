// How the error of each technique falls with the map's size.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "compare/result/number_text.h"
#include "report/log_chart.h"
#include "studies/sweep/charts.h"

namespace gnomon::compare {
namespace {

constexpr std::size_t styles = 6;  // line-0 ... in report.css

using SizeCurve = std::map<double, const CellSummary*>;  // size -> the cell with the least wrong fraction

std::map<std::string, SizeCurve> lines_of(const std::vector<CellSummary>& cells) {
  std::map<std::string, SizeCurve> lines;
  for (const CellSummary& cell : cells) {
    const auto [entry, first] = lines[cell.technique].emplace(cell.map_size, &cell);
    if (!first && cell.error() < entry->second->error()) entry->second = &cell;
  }
  return lines;
}

std::string drawing(const LogPlot& plot, const SizeCurve& line, std::string_view stroke,
                    std::string_view fill) {
  std::string points, dots;
  for (const auto& [size, cell] : line) {
    const double x = plot.x(size), y = plot.y(cell->error());
    fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ", x, y);
    dots += cell_point(*cell, fill, x, y, 4.0,
                       fmt::format("{}, {:g} texels: error {}", cell->technique, size, error_words(*cell)));
  }
  return fmt::format("<polyline class=\"curve {}\" points=\"{}\"/>", stroke, points) + dots;
}

// From the worst of the smallest maps on; nothing where all is right.
std::string sampling_slope(const LogPlot& plot, const std::map<std::string, SizeCurve>& lines, double first,
                           double last, ChartLabels& labels) {
  double start = 0.0;
  for (const auto& [name, line] : lines)
    if (const auto at = line.find(first); at != line.end()) start = std::max(start, at->second->error());
  if (!(start > 0.0)) return {};
  const double end = start * first / last, lowest = std::max(end, plot.min_y);
  const double end_size = start * first / lowest;
  labels.keep_line_free(plot.x(first), plot.y(start), plot.x(end_size), plot.y(lowest));
  return fmt::format("<line class=\"used\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                     plot.x(first), plot.y(start), plot.x(end_size), plot.y(lowest)) +
         labels.place(plot.x(std::sqrt(first * end_size)), plot.y(std::sqrt(start * lowest)),
                      "half at twice the size");
}

}  // namespace

std::string size_chart(const std::vector<CellSummary>& cells) {
  const std::map<std::string, SizeCurve> lines = lines_of(cells);
  std::vector<double> sizes, shares;
  for (const auto& [name, line] : lines)
    for (const auto& [size, cell] : line) sizes.push_back(size), shares.push_back(cell->error());
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  if (sizes.size() < 3) return {};
  const double least = least_error(shares), most = *std::max_element(shares.begin(), shares.end());
  const LogPlot plot{sizes.front() / 1.1, sizes.back() * 1.1, least, std::max(4.0 * least, 1.5 * most),
                     !cells.front().is_filmed()};
  std::string out = chart_frame(plot, sizes, "texels on a side"), names;
  ChartLabels labels;
  for (const auto& [name, line] : lines) {
    const CellSummary* before = nullptr;
    for (const auto& [size, cell] : line) {
      const double x = plot.x(size), y = plot.y(cell->error());
      labels.keep_free(x - 5, y - 5, x + 5, y + 5);
      if (before != nullptr) labels.keep_line_free(plot.x(before->map_size), plot.y(before->error()), x, y);
      before = cell;
    }
  }
  if (lines.size() > 1)
    for (const auto& [name, line] : lines)
      names += labels.place(plot.x(line.rbegin()->first), plot.y(line.rbegin()->second->error()), name);
  if (plot.shares) out += sampling_slope(plot, lines, sizes.front(), sizes.back(), labels);
  std::size_t i = 0;
  for (const auto& [name, line] : lines) {
    const std::string own = fmt::format("line-{}", i++ % styles);
    out += lines.size() > 1 ? drawing(plot, line, own, own) : drawing(plot, line, "front", "dot best-dot");
  }
  return chart_svg("Least error against map size, a line for each technique", out + names);
}

}  // namespace gnomon::compare
