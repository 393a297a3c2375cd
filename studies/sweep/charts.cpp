#include "studies/sweep/charts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/result/number_text.h"
#include "report/html.h"
#include "report/log_chart.h"
#include "studies/sweep/headline.h"

namespace gnomon::compare {
namespace {

/// What tells a cell of the front from the others: its technique and map size, where the cells differ in
/// them.
std::string short_name(const CellSummary& cell, bool techniques, bool sizes) {
  const std::string size = fmt::format("{:g}", cell.map_size);
  if (!techniques) return sizes ? size : std::string();
  return sizes ? cell.technique + " " + size : cell.technique;
}

std::string front_names(const LogPlot& plot, const std::vector<CellSummary>& cells,
                        const std::vector<std::size_t>& front, ChartLabels& labels) {
  const auto differ = [&](auto member) {
    return std::any_of(cells.begin(), cells.end(),
                       [&](const CellSummary& c) { return c.*member != cells.front().*member; });
  };
  const bool techniques = differ(&CellSummary::technique), sizes = differ(&CellSummary::map_size);
  std::string out;
  for (const std::size_t i : front)
    if (const std::string name = short_name(cells[i], techniques, sizes); !name.empty())
      out += labels.place(plot.x(cells[i].raster_ms), plot.y(cells[i].error()), name);
  return out;
}

// As CellSummary::error(). Exact shadows do not flip.
double error_of(const RayPoint& tracer, bool filmed) {
  if (filmed) return 0.0;
  const double wrong = double(tracer.wrong) / double(std::max<std::uint64_t>(tracer.compared, 1));
  return std::max(wrong, tracer.mean_absolute);
}

std::string diamond(const LogPlot& plot, const RayPoint& tracer, ChartLabels& labels) {
  const double x = plot.x(tracer.times.median()), error = error_of(tracer, !plot.shares), y = plot.y(error);
  return fmt::format(
             "<path class=\"rays\" d=\"M{0:.1f},{1:.1f}l7,7l-7,7l-7,-7z\"><title>{2}: {3} {5}, "
             "{4}</title></path>",
             x, y - 7, escaped(tracer.name), error == 0.0 ? "none" : percent(error),
             milliseconds(tracer.times.median()), plot.shares ? "wrong" : "flip") +
         labels.place(x, y, tracer.name);
}

}  // namespace

std::string cell_point(const CellSummary& cell, std::string_view kind, double x, double y, double radius,
                       const std::string& title) {
  return fmt::format(
      "<a href=\"#cell-{0}\" aria-label=\"Cell {0}, {5}\"><circle class=\"{1}\" cx=\"{2:.1f}\" "
      "cy=\"{3:.1f}\" "
      "r=\"{4}\"><title>{5}</title></circle></a>",
      cell.cell, kind, x, y, radius, escaped(title));
}

std::string pareto_chart(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                         const std::vector<RayPoint>& measured) {
  if (front.empty()) return {};
  std::vector<RayPoint> tracers = measured;
  if (tracers.empty() && cells.front().rays_ms > 0.0) {
    tracers.emplace_back().name = "ray tracing";
    tracers.back().times.runs = {cells.front().rays_ms};
  }
  double low = cells[front.front()].raster_ms, high = low;
  for (const RayPoint& tracer : tracers)
    low = std::min(low, tracer.times.median()), high = std::max(high, tracer.times.median());
  for (const CellSummary& cell : cells)
    if (std::isfinite(cell.raster_ms))
      low = std::min(low, cell.raster_ms), high = std::max(high, cell.raster_ms);
  std::vector<double> shares;
  for (const CellSummary& cell : cells) shares.push_back(cell.error());
  for (const RayPoint& tracer : tracers) shares.push_back(error_of(tracer, cells.front().is_filmed()));
  const double least = least_error(shares);
  const LogPlot plot{low / 1.15, high * 1.15, least,
                     std::max(4.0 * least, 1.3 * *std::max_element(shares.begin(), shares.end())),
                     !cells.front().is_filmed()};
  std::string out = chart_frame(plot, log_ticks(plot.min_x, plot.max_x), "milliseconds for map and shading");
  std::string line;
  for (const std::size_t i : front)
    fmt::format_to(std::back_inserter(line), "{:.1f},{:.1f} ", plot.x(cells[i].raster_ms),
                   plot.y(cells[i].error()));
  out += fmt::format("<polyline class=\"curve front\" points=\"{}\"/>", line);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellSummary& cell = cells[i];
    if (!std::isfinite(cell.raster_ms)) continue;
    const bool best = std::find(front.begin(), front.end(), i) != front.end();
    out += cell_point(
        cell, best ? "dot best-dot" : "dot", plot.x(cell.raster_ms), plot.y(cell.error()), best ? 5.0 : 3.5,
        fmt::format("{}: {}{} wrong, mean error {}, {}", axes_words(cell),
                    cell.is_filmed() ? error_words(cell) + ", " : std::string(), percent(cell.wrong_fraction),
                    percent(cell.mean_absolute), milliseconds(cell.raster_ms)));
  }
  ChartLabels labels;
  for (const RayPoint& tracer : tracers) {
    const double x = plot.x(tracer.times.median()), y = plot.y(error_of(tracer, !plot.shares));
    labels.keep_free(x - 7, y - 7, x + 7, y + 7);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const CellSummary& cell = cells[front[k]];
    const double x = plot.x(cell.raster_ms), y = plot.y(cell.error());
    labels.keep_free(x - 6, y - 6, x + 6, y + 6);
    if (k == 0) continue;
    const CellSummary& before = cells[front[k - 1]];
    labels.keep_line_free(plot.x(before.raster_ms), plot.y(before.error()), x, y);
  }
  for (const RayPoint& tracer : tracers) out += diamond(plot, tracer, labels);
  out += front_names(plot, cells, front, labels);
  return chart_svg("Error against time, each cell a point, the best of them joined", out);
}

}  // namespace gnomon::compare
