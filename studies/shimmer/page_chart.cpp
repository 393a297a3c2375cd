#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"
#include "report/charts.h"
#include "report/html.h"
#include "studies/shimmer/page.h"

namespace gnomon::compare {
namespace {

constexpr double plot_left = 70.0, plot_right = 980.0, plot_top = 16.0,
                 plot_bottom = 220.0;  // of the plot, in the drawing's units

double x_of(std::size_t step, std::size_t steps) {
  return plot_left + (plot_right - plot_left) * (steps > 1 ? double(step) / double(steps - 1) : 0.5);
}

double y_of(double value, double most) {
  return plot_bottom - (plot_bottom - plot_top) * value / most;
}

std::string ticks(double most, std::size_t steps) {
  std::string out;
  for (const double tick : nice_ticks(0.0, most, 4))
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text class=\"end\" "
        "x=\"{3}\" y=\"{4:.1f}\">{5}</text>",
        plot_left, plot_right, y_of(tick, most), plot_left - 8, y_of(tick, most) + 4, plain_number(tick));
  for (const double tick : nice_ticks(2.0, double(steps) + 1.0, 8)) {  // frames are counted from one
    if (tick != std::floor(tick)) continue;
    out += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{}\">{:g}</text>",
                       x_of(static_cast<std::size_t>(tick) - 2, steps), plot_bottom + 18, tick);
  }
  return out + fmt::format("<text class=\"middle\" x=\"{}\" y=\"{}\">to frame</text>",
                           0.5 * (plot_left + plot_right), plot_bottom + 36);
}

}  // namespace

std::string flips_chart(const Shimmer& shimmer, const ShimmerLight& light, std::size_t index) {
  const std::vector<TemporalSums>& steps = light.temporal.transitions();
  double most = 1.0;
  for (const TemporalSums& step : steps) most = std::max(most, double(step.flips));
  std::string points, dots;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = x_of(i, steps.size()), y = y_of(double(steps[i].flips), most);
    points += fmt::format("{}{:.1f},{:.1f}", i > 0 ? " " : "", x, y);
    dots += fmt::format(
        "<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"><title>to frame {}: {} "
        "flips</title></circle>",
        x, y, i + 2, grouped(steps[i].flips));
  }
  return fmt::format(
      "<svg class=\"chart flips-chart\" viewBox=\"0 0 1000 264\" role=\"img\" aria-label=\"Flips from frame "
      "to frame of "
      "{}\" data-light=\"{}\">{}<polyline class=\"flips-line\" points=\"{}\"/>{}<line class=\"now\" "
      "x1=\"{}\" x2=\"{}\" "
      "y1=\"{}\" y2=\"{}\"/></svg>",
      escaped(shimmer.world->scene->lights[light.light].name), index, ticks(most, steps.size()), points, dots,
      plot_left, plot_left, plot_top, plot_bottom);
}

}  // namespace gnomon::compare
