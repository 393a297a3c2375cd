#include "report/log_chart.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/result/number_text.h"
#include "report/html.h"

namespace gnomon::compare {

double LogPlot::x(double v) const {
  return left + std::log(v / min_x) / std::log(max_x / min_x) * (width - left - right);
}

double LogPlot::y(double v) const {
  const double inside = std::max(v, min_y);
  return height - bottom - std::log(inside / min_y) / std::log(max_y / min_y) * (height - top - bottom);
}

bool ChartLabels::is_free(const Box& box) const {
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
    return box.x0 < other.x1 && other.x0 < box.x1 && box.y0 < other.y1 && other.y0 < box.y1;
  });
}

void ChartLabels::keep_line_free(double x0, double y0, double x1, double y1) {
  constexpr double step = 6.0, half_width = 2.0;
  const int steps = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / step) + 1;
  for (int i = 0; i <= steps; ++i) {
    const double x = x0 + (x1 - x0) * i / steps, y = y0 + (y1 - y0) * i / steps;
    keep_free(x - half_width, y - half_width, x + half_width, y + half_width);
  }
}

std::string ChartLabels::place(double x, double y, std::string_view name) {
  constexpr double glyph = 7.2, ascent = 11.0, descent = 4.0, gap = 13.0;  // of 13 px text, and to the point
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) return {};
  const double length = glyph * static_cast<double>(name.size());
  struct Place {
    const char* anchor;
    double dx, dy, from;  // from: the text's beginning, in lengths left of its anchor
  };
  constexpr std::array<Place, 8> places{{{"middle", 0.0, -gap, 0.5},
                                         {"middle", 0.0, 1.8 * gap, 0.5},
                                         {"start", gap, 4.0, 0.0},
                                         {"end", -gap, 4.0, 1.0},
                                         {"start", gap, -gap, 0.0},
                                         {"end", -gap, -gap, 1.0},
                                         {"start", gap, 2.0 * gap, 0.0},
                                         {"end", -gap, 2.0 * gap, 1.0}}};
  for (const Place& p : places) {
    const double from = x + p.dx - p.from * length, base = y + p.dy;
    const Box box{from, base - ascent, from + length, base + descent};
    const bool inside = box.x0 >= LogPlot::left && box.x1 <= LogPlot::width && box.y0 >= 0.0 &&
                        box.y1 <= LogPlot::height - LogPlot::bottom + 10.0;
    if (!inside || !is_free(box)) continue;
    taken_.push_back(box);
    names_.emplace_back(name);
    return chart_text(x + p.dx, base, std::string("note ") + p.anchor, name);
  }
  return {};
}

std::vector<double> log_ticks(double min, double max) {
  const auto at = [min, max](const std::vector<double>& digits) {
    std::vector<double> ticks;
    for (int exponent = static_cast<int>(std::floor(std::log10(min))); std::pow(10.0, exponent) <= max;
         ++exponent)
      for (const double digit : digits)
        if (const double v = digit * std::pow(10.0, exponent); v >= min && v <= max) ticks.push_back(v);
    return ticks;
  };
  if (max / min > 300.0) return at({1.0});
  constexpr std::size_t enough = 3;
  std::vector<double> ticks = at({1.0, 2.0, 5.0});
  if (ticks.size() < enough) ticks = at({1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0});
  if (ticks.size() < enough)
    ticks = at({1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7, 7.5, 8, 8.5, 9, 9.5});
  return ticks;
}

double least_error(const std::vector<double>& shares) {
  double least = 1.0;
  for (const double share : shares)
    if (share > 0.0) least = std::min(least, share / 4.0);
  return least < 1.0 ? least : 0.001;
}

std::string chart_text(double x, double y, std::string_view kind, std::string_view content) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kind, x, y, escaped(content));
}

std::string chart_frame(const LogPlot& plot, const std::vector<double>& ticks_x, std::string_view unit_x) {
  constexpr double left = LogPlot::left, right = LogPlot::width - LogPlot::right;
  constexpr double floor = LogPlot::height - LogPlot::bottom;
  std::string out;
  for (const double v : log_ticks(plot.min_y * 1.6, plot.max_y)) {  // above the word at the bottom
    out += fmt::format("<line class=\"grid\" x1=\"{:.0f}\" x2=\"{:.0f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", left,
                       right, plot.y(v), plot.y(v));
    out += chart_text(left - 8, plot.y(v) + 4, "tick end",
                      plot.shares ? fmt::format("{:.3g} %", 100.0 * v) : plain_number(v));
  }
  out += chart_text(left - 8, plot.y(plot.min_y) + 4, "tick end", "none");
  for (const double v : ticks_x) {
    out += fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>",
                       plot.x(v), floor + 4, floor + 9);
    out += chart_text(plot.x(v), floor + 24, "tick middle", plain_number(v));
  }
  return out + chart_text(right, LogPlot::height - 8, "tick end", unit_x);
}

std::string chart_svg(std::string_view title, const std::string& content) {
  return fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"group\" aria-label=\"{}\">{}</svg>\n",
      LogPlot::width, LogPlot::height, escaped(title), content);
}

}  // namespace gnomon::compare
