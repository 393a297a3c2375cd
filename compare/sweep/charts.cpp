#include "compare/sweep/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "compare/number_text.h"
#include "compare/report/html.h"
#include "compare/report/log_chart.h"

namespace gnomon::compare {
namespace {

std::vector<double> wrong_shares(const std::vector<CellSummary>& cells) {
  std::vector<double> shares;
  for (const CellSummary& cell : cells) shares.push_back(cell.wrong_fraction);
  return shares;
}

std::string axes_text(const CellSummary& cell) {
  std::string out;
  for (const auto& [name, value] : cell.axes)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name, value);
  return out.empty() ? "the only cell" : out;
}

// A cell as a point that leads to it.
std::string point(const CellSummary& cell, std::string_view kind, double x, double y, double radius,
                  const std::string& title) {
  return fmt::format(
      "<a href=\"#cell-{0}\" aria-label=\"Cell {0}, {5}\"><circle class=\"{1}\" cx=\"{2:.1f}\" "
      "cy=\"{3:.1f}\" "
      "r=\"{4}\"><title>{5}</title></circle></a>",
      cell.cell, kind, x, y, radius, escaped(title));
}

double largest_error(const std::vector<double>& shares) {
  return *std::max_element(shares.begin(), shares.end());
}

double wrong_share(const RayPoint& tracer) {
  return double(tracer.wrong) / double(std::max<std::uint64_t>(tracer.compared, 1));
}

std::string diamond(const LogPlot& plot, const RayPoint& tracer, ChartLabels& labels) {
  const double x = plot.x(tracer.times.median()), y = plot.y(wrong_share(tracer));
  return fmt::format(
             "<path class=\"rays\" d=\"M{0:.1f},{1:.1f}l7,7l-7,7l-7,-7z\"><title>{2}: {3} wrong, "
             "{4}</title></path>",
             x, y - 7, escaped(tracer.name), tracer.wrong == 0 ? "none" : percent(wrong_share(tracer)),
             milliseconds(tracer.times.median())) +
         labels.place(x, y, tracer.name);
}

}  // namespace

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
  std::vector<double> shares = wrong_shares(cells);
  for (const RayPoint& tracer : tracers) shares.push_back(wrong_share(tracer));
  const double least = least_error(shares);
  const LogPlot plot{low / 1.15, high * 1.15, least, std::max(4.0 * least, 1.3 * largest_error(shares))};
  std::string out = chart_frame(plot, log_ticks(plot.min_x, plot.max_x), "milliseconds for map and shading");
  std::string line;
  for (const std::size_t i : front)
    fmt::format_to(std::back_inserter(line), "{:.1f},{:.1f} ", plot.x(cells[i].raster_ms),
                   plot.y(cells[i].wrong_fraction));
  out += fmt::format("<polyline class=\"curve front\" points=\"{}\"/>", line);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellSummary& cell = cells[i];
    if (!std::isfinite(cell.raster_ms)) continue;
    const bool best = std::find(front.begin(), front.end(), i) != front.end();
    out += point(cell, best ? "dot best-dot" : "dot", plot.x(cell.raster_ms), plot.y(cell.wrong_fraction),
                 best ? 5.0 : 3.5,
                 fmt::format("{}: {} wrong, {}", axes_text(cell), percent(cell.wrong_fraction),
                             milliseconds(cell.raster_ms)));
  }
  ChartLabels labels;
  for (const RayPoint& tracer : tracers) {
    const double x = plot.x(tracer.times.median()), y = plot.y(wrong_share(tracer));
    labels.keep_free(x - 7, y - 7, x + 7, y + 7);
  }
  for (const RayPoint& tracer : tracers) out += diamond(plot, tracer, labels);
  return chart_svg("Wrong pixels against time, each cell a point, the best of them joined", out);
}

std::string size_chart(const std::vector<CellSummary>& cells) {
  std::map<double, const CellSummary*> best;  // size -> cell with the least wrong fraction
  for (const CellSummary& cell : cells) {
    const auto [entry, first] = best.emplace(cell.map_size, &cell);
    if (!first && cell.wrong_fraction < entry->second->wrong_fraction) entry->second = &cell;
  }
  if (best.size() < 3) return {};
  const std::vector<double> shares = wrong_shares(cells);
  const double least = least_error(shares);
  const LogPlot plot{best.begin()->first / 1.1, best.rbegin()->first * 1.1, least,
                     std::max(4.0 * least, 1.5 * largest_error(shares))};
  std::vector<double> sizes;
  std::string line, dots;
  for (const auto& [size, cell] : best) {
    sizes.push_back(size);
    fmt::format_to(std::back_inserter(line), "{:.1f},{:.1f} ", plot.x(size), plot.y(cell->wrong_fraction));
    dots += point(*cell, "dot best-dot", plot.x(size), plot.y(cell->wrong_fraction), 4.0,
                  fmt::format("{:g} texels: {} wrong", size, percent(cell->wrong_fraction)));
  }
  std::string out = chart_frame(plot, sizes, "texels on a side");
  const double start = std::max(best.begin()->second->wrong_fraction, least), last = best.rbegin()->first;
  const double end = start * best.begin()->first / last;
  out += fmt::format("<line class=\"used\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                     plot.x(best.begin()->first), plot.y(start), plot.x(last), plot.y(std::max(end, least)));
  out += chart_text(plot.x(last) - 6, plot.y(std::max(end, least)) + 18, "note end", "slope \u22121");
  out += fmt::format("<polyline class=\"curve front\" points=\"{}\"/>", line) + dots;
  return chart_svg("Least share of wrong pixels against map size", out);
}

}  // namespace gnomon::compare
