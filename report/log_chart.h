// Charts of wrong pixels on two logarithmic scales, as inline SVG styled by report.css: what the sweep's and
// the tuner's pages share. An error of none stands on the lowest line, named "none".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon::compare {

/// Where values stand; SVG units.
struct LogPlot {
  static constexpr double width = 760.0, height = 380.0;
  static constexpr double left = 84.0, right = 24.0, top = 24.0, bottom = 52.0;
  double min_x, max_x, min_y, max_y;
  bool shares = true;  ///< values along y are shares, written in per cent; else plain numbers

  double x(double v) const;
  /// Values below min_y stand on it.
  double y(double v) const;
};

/// Names beside points: each takes the first place, of a few around its point, where it covers no other.
class ChartLabels {
 public:
  /// An SVG text, or nothing where there is no room or the same name stands already.
  std::string place(double x, double y, std::string_view name);
  /// Room that names keep off.
  void keep_free(double x0, double y0, double x1, double y1) { taken_.push_back({x0, y0, x1, y1}); }
  /// A straight line that names keep off.
  void keep_line_free(double x0, double y0, double x1, double y1);

 private:
  struct Box {
    double x0, y0, x1, y1;
  };
  bool is_free(const Box& box) const;
  std::vector<Box> taken_;
  std::vector<std::string> names_;
};

/// 1, 2 and 5 times the powers of ten inside; powers alone when the range is long, more when it is short.
std::vector<double> log_ticks(double min, double max);

/// What the scale takes for none: well below the least error that there is.
double least_error(const std::vector<double>& shares);

std::string chart_text(double x, double y, std::string_view kind, std::string_view content);

/// Lines and ticks; `unit_x` names the horizontal axis.
std::string chart_frame(const LogPlot& plot, const std::vector<double>& ticks_x, std::string_view unit_x);

std::string chart_svg(std::string_view title, const std::string& content);

}  // namespace gnomon::compare
