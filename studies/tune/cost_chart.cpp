// What accuracy costs: every map that the search drew as a point, the error wanted small against
// milliseconds, the goal as a line, and those that no other beats in both joined and named.
#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "report/html.h"
#include "report/log_chart.h"
#include "studies/tune/page.h"

namespace gnomon::compare {
namespace {

struct Point {
  const FamilyResult* family;
  int size;
  double error, time_ms;
  LightFigures figures;
  bool answer;
};

// The sizes that were drawn again have the times of that.
std::vector<Point> points_of(const TuneResult& result) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < result.families.size(); ++i) {
    const FamilyResult& family = result.families[i];
    const Attempt& chosen = family.answer ? *family.answer : family.closest;
    for (const Attempt& tried : family.tried) {
      const Attempt& a = tried.size == chosen.size ? chosen : tried;
      points.push_back({&family, a.size, a.error, a.time_ms, a.figures, i == result.winner && &a == &chosen});
    }
  }
  std::erase_if(points, [](const Point& p) { return !(p.time_ms > 0.0); });
  return points;
}

// Cheapest first.
std::vector<Point> front_of(std::vector<Point> points) {
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.time_ms != b.time_ms ? a.time_ms < b.time_ms : a.error < b.error;
  });
  std::vector<Point> front;
  for (const Point& p : points)
    if (front.empty() || p.error < front.back().error) front.push_back(p);
  return front;
}

// The answer first, whose label finds its place before all others. It may be none of the front's: where times differ by
// their noise alone, others decide.
std::vector<Point> named_of(const std::vector<Point>& points, const std::vector<Point>& front) {
  std::vector<Point> named;
  for (const Point& p : points)
    if (p.answer) named.push_back(p);
  for (const Point& p : front)
    if (!p.answer) named.push_back(p);
  return named;
}

LogPlot plot_of(const std::vector<Point>& points, const TuneGoal& goal) {
  double low = points.front().time_ms, high = low, most = 0.0;
  std::vector<double> shares;
  for (const Point& p : points) {
    low = std::min(low, p.time_ms), high = std::max(high, p.time_ms), most = std::max(most, p.error);
    shares.push_back(p.error);
  }
  if (goal.max_time_ms) low = std::min(low, *goal.max_time_ms), high = std::max(high, *goal.max_time_ms);
  if (goal.max_error && goal.max_error->limit > 0.0)
    shares.push_back(goal.max_error->limit), most = std::max(most, goal.max_error->limit);
  const double least = least_error(shares);
  return {low / 1.15, high * 1.15, least, std::max(4.0 * least, 1.3 * most),
          goal.measure().form() == FigureForm::percent};
}

std::string goal_line(const LogPlot& plot, const TuneGoal& goal) {
  constexpr double left = LogPlot::left, right = LogPlot::width - LogPlot::right;
  const auto line = [](double x0, double y0, double x1, double y1) {
    return fmt::format(R"(<line class="used" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", x0, y0, x1,
                       y1);
  };
  if (goal.max_time_ms) {
    const double x = plot.x(*goal.max_time_ms);
    return line(x, LogPlot::top, x, LogPlot::height - LogPlot::bottom) +
           chart_text(x - 6, LogPlot::top + 10, "note end", "wanted");
  }
  const double y = plot.y(goal.max_error->limit);
  return line(left, y, right, y) + chart_text(right, y - 5, "note end", "wanted");
}

std::string dot(const LogPlot& plot, const Point& p, const Figure& measure, bool best) {
  return fmt::format(
      R"(<circle class="dot{}" cx="{:.1f}" cy="{:.1f}" r="{}"><title>{}, {} texels: {}; {}</title></circle>)",
      best ? " best-dot" : "", plot.x(p.time_ms), plot.y(p.error),
      p.answer ? 8.0
      : best   ? 5.0
               : 3.5,
      escaped(p.family->family.name), p.size, figure_words(p.figures, measure), milliseconds(p.time_ms));
}

}  // namespace

std::string tune_cost_chart(const TuneGoal& goal, const TuneResult& result) {
  const std::vector<Point> points = points_of(result);
  if (points.size() < 2) return {};
  const std::vector<Point> front = front_of(points);
  const LogPlot plot = plot_of(points, goal);
  std::string out = chart_frame(plot, log_ticks(plot.min_x, plot.max_x), "milliseconds for map and shading") +
                    goal_line(plot, goal);
  std::string line;
  ChartLabels labels;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const Point& p = front[i];
    const Point& next = front[std::min(i + 1, front.size() - 1)];
    fmt::format_to(std::back_inserter(line), "{:.1f},{:.1f} ", plot.x(p.time_ms), plot.y(p.error));
    labels.keep_line_free(plot.x(p.time_ms), plot.y(p.error), plot.x(next.time_ms), plot.y(next.error));
  }
  const std::vector<Point> named = named_of(points, front);
  for (const Point& p : named) {
    const double x = plot.x(p.time_ms), y = plot.y(p.error), reach = p.answer ? 11 : 8;
    labels.keep_free(x - reach, y - reach, x + reach, y + reach);
  }
  out += fmt::format(R"(<polyline class="curve front" points="{}"/>)", line);
  for (const Point& p : points) out += dot(plot, p, goal.measure(), false);
  for (const Point& p : named) out += dot(plot, p, goal.measure(), true);
  for (const Point& p : named)
    out += labels.place(plot.x(p.time_ms), plot.y(p.error),
                        fmt::format("{} {}", technique_name(p.family->family.map.technique), p.size));
  return chart_svg("Error against time, each map tried a point, the best of them joined", out);
}

}  // namespace gnomon::compare
