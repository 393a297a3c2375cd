#include "report/charts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/result/number_text.h"
#include "compare/result/palette.h"
#include "report/html.h"

namespace gnomon::compare {
namespace {

constexpr double width = 760.0, height = 340.0;  // of the bias chart, SVG units (CSS pixels when not scaled)
constexpr double left = 58.0, right = 152.0, top = 40.0,
                 bottom = 56.0;         // margins; names of curves on the right
constexpr double nothing_wrong = 0.01;  // the vertical axis's end where no bias makes a pixel wrong

// Maps the chart's data to SVG units.
struct Scale {
  double min_x, max_x, max_y;
  double x(double v) const { return left + (v - min_x) / (max_x - min_x) * (width - left - right); }
  double y(double v) const { return height - bottom - v / max_y * (height - top - bottom); }
  double clamp_x(double v) const { return x(std::clamp(v, min_x, max_x)); }
};

std::string vertical(double x, std::string_view kind) {
  return fmt::format(R"(<line class="{}" x1="{:.1f}" x2="{:.1f}" y1="{:.0f}" y2="{:.0f}"/>)", kind, x, x, top,
                     height - bottom);
}

std::string label(double x, double y, std::string_view kind, std::string_view text) {
  return fmt::format(R"(<text class="{}" x="{:.1f}" y="{:.1f}">{}</text>)", kind, x, y, escaped(text));
}

// One row of ticks below the plot, in multiples of `unit` world units, its name at the right end.
std::string bias_ticks(const Scale& scale, double unit, double below, std::string_view name) {
  std::string out;
  const double y = height - bottom + below;
  for (const double v : nice_ticks(scale.min_x / unit, scale.max_x / unit, 6)) {
    out += fmt::format(R"(<line class="mark" x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}"/>)",
                       scale.x(v * unit), y - 15, y - 11);
    out += label(scale.x(v * unit), y, "tick middle", fmt::format("{:.3g}", v));
  }
  return out + label(width - right + 26, y, "tick", name);
}

std::string axes(const Scale& scale, double texel_world) {
  std::string out;
  for (const double v : nice_ticks(0.0, scale.max_y, 4)) {
    out += fmt::format(R"(<line class="grid" x1="{:.0f}" x2="{:.0f}" y1="{:.1f}" y2="{:.1f}"/>)", left,
                       width - right, scale.y(v), scale.y(v));
    out += label(left - 8, scale.y(v) + 4, "tick end", fmt::format("{:.3g} %", 100.0 * v));
  }
  out += bias_ticks(scale, 1.0, 20, "bias, world units");
  return texel_world > 0.0 ? out + bias_ticks(scale, texel_world, 46, "bias, texels") : out;
}

template <class Value>
std::string curve(const LightComparison& light, const Scale& scale, std::string_view kind,
                  const Value& value) {
  std::string points;
  for (const BiasCurvePoint& p : light.bias_curve)
    fmt::format_to(std::back_inserter(points), "{}{:.1f},{:.1f}", points.empty() ? "" : " ", scale.x(p.bias),
                   scale.y(value(p)));
  return fmt::format(R"(<polyline class="curve {}" points="{}"/>)", kind, points);
}

// Names at the curves' right ends, moved apart so that they do not overlap.
std::string curve_names(const LightComparison& light, const Scale& scale, double compared) {
  struct Name {
    double y;
    std::string_view kind, text;
  };
  const BiasCurvePoint& last = light.bias_curve.back();
  const auto f = static_cast<double>(last.false_shadow), m = static_cast<double>(last.missed_shadow);
  std::array<Name, 3> names{{{scale.y((f + m) / compared), "total", "all wrong"},
                             {scale.y(m / compared), "missed", "missed shadow"},
                             {scale.y(f / compared), "false", "false shadow"}}};
  std::stable_sort(names.begin(), names.end(), [](const Name& a, const Name& b) { return a.y < b.y; });
  constexpr double spacing = 16.0;
  for (std::size_t i = 1; i < names.size(); ++i) names[i].y = std::max(names[i].y, names[i - 1].y + spacing);
  const double excess = std::max(0.0, names.back().y - (height - bottom));
  std::string out;
  for (const Name& n : names)
    out += label(width - right + 8, n.y - excess + 4, fmt::format("name {}", n.kind), n.text);
  return out;
}

// The interval of biases that make every compared pixel right, where there is one.
std::string feasible_interval(const BestBias& best, const Scale& scale) {
  if (!best.feasible) return "";
  const double from = scale.clamp_x(best.needs_more_than), to = scale.clamp_x(best.needs_less_than);
  return fmt::format(R"(<rect class="feasible" x="{:.1f}" y="{:.0f}" width="{:.1f}" height="{:.0f}"/>)", from,
                     top, std::max(1.0, to - from), height - top - bottom) +
         label(std::clamp((from + to) / 2, left + 60, width - right - 60), top - 24, "note middle",
               "right everywhere");
}

std::string description(const LightComparison& light, double used_bias) {
  const BestBias& b = light.best_bias;
  const std::string best =
      fmt::format("Best: {}, {} wrong.", plain_number(b.constant_world), percent(b.wrong_fraction));
  if (std::isnan(used_bias)) return best;
  return fmt::format("Used: a bias of {}, {} of the compared pixels wrong. {}", plain_number(used_bias),
                     percent(light.error.wrong_fraction), best);
}

// Used and best bias as marks with their names above the plot, the right one's name to the right of its line.
std::string marks(const LightComparison& light, const Scale& scale, double used_bias) {
  const double best = scale.clamp_x(light.best_bias.constant_world);
  const double used = std::isnan(used_bias) ? best : scale.clamp_x(used_bias);
  const bool best_is_right = best >= used;
  std::string out = vertical(best, "best");
  out += label(best + (best_is_right ? 5 : -5), top - 7, best_is_right ? "note" : "note end", "best");
  if (std::abs(best - used) < 1.0) return out;
  out += vertical(used, "used");
  return out + label(used + (best_is_right ? -5 : 5), top - 7, best_is_right ? "note end" : "note", "used");
}

}  // namespace

std::vector<double> nice_ticks(double min, double max, int wanted) {
  std::vector<double> ticks;
  if (!(max > min) || wanted < 1) return ticks;
  const double rough = (max - min) / wanted, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double lead = rough / power;
  const double step = power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
  for (double k = std::ceil(min / step); k * step <= max; k += 1.0) ticks.push_back(k * step + 0.0);
  return ticks;
}

std::string two_sided_bar(const TwoSides& done, const TwoSides& left, double scale) {
  const auto width = [&](double v) { return v > 0.0 ? std::max(490.0 * v / scale, 1.5) : 0.0; };
  const auto bar = [&](double v, std::string_view kind, double opacity) {
    const double w = width(v);
    return fmt::format(R"(<rect class="{}" x="{:.1f}" y="5" width="{:.1f}" height="14" opacity="{}"/>)", kind,
                       kind == "minus" ? 500.0 - w : 500.0, w, opacity);
  };
  constexpr double pale = 0.35;
  return fmt::format(
      R"(<svg class="bar" viewBox="0 0 1000 24" preserveAspectRatio="none" aria-hidden="true"
focusable="false">{}{}{}{}<line class="zero" x1="500" x2="500" y1="0" y2="24"/></svg>)",
      bar(done.darker, "minus", pale), bar(done.lighter, "plus", pale), bar(left.darker, "minus", 1.0),
      bar(left.lighter, "plus", 1.0));
}

std::string share_bar(double share, std::string_view kind) {
  return fmt::format(
      R"(<svg class="bar" viewBox="0 0 1000 24" preserveAspectRatio="none" aria-hidden="true"
focusable="false"><rect class="{}" x="0" y="7" width="{:.1f}" height="10"/></svg>)",
      kind, share > 0.0 ? std::max(1000.0 * std::min(share, 1.0), 1.5) : 0.0);
}

std::string bias_chart(const LightComparison& light, double used_bias, std::string_view id) {
  if (light.bias_curve.size() < 2 || light.pixels.compared == 0) return "";
  const auto compared = static_cast<double>(light.pixels.compared);
  const auto total = [](const BiasCurvePoint& p) {
    return static_cast<double>(p.false_shadow + p.missed_shadow);
  };
  double highest = 0.0;
  for (const BiasCurvePoint& p : light.bias_curve) highest = std::max(highest, total(p) / compared);
  const Scale scale{light.bias_curve.front().bias, light.bias_curve.back().bias,
                    highest > 0.0 ? 1.05 * highest : nothing_wrong};
  if (!(scale.max_x > scale.min_x)) return "";
  std::string svg = fmt::format(
      R"(<svg class="chart" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-labelledby="{}-title {}-desc"
data-left="{}" data-right="{}" data-top="{}" data-bottom="{}" data-from="{}" data-to="{}"><title
id="{}-title">Wrong pixels at every constant bias</title><desc id="{}-desc">{}</desc>)",
      width, height, id, id, left, width - right, top, height - bottom, scale.min_x, scale.max_x, id, id,
      escaped(description(light, used_bias)));
  svg += feasible_interval(light.best_bias, scale) + axes(scale, light.bias_texel_world);
  svg += curve(light, scale, "total", [&](const BiasCurvePoint& p) { return total(p) / compared; });
  svg += curve(light, scale, "false",
               [&](const BiasCurvePoint& p) { return static_cast<double>(p.false_shadow) / compared; });
  svg += curve(light, scale, "missed",
               [&](const BiasCurvePoint& p) { return static_cast<double>(p.missed_shadow) / compared; });
  return svg + marks(light, scale, used_bias) + curve_names(light, scale, compared) + "</svg>";
}

std::string depth_scale(std::string_view id) {
  std::string stops;
  for (int i = 0; i <= 8; ++i) {
    const glm::u8vec3 c = viridis(i / 8.0);
    stops += fmt::format(R"(<stop offset="{}" stop-color="{}"/>)", i / 8.0, hex_colour(c.r, c.g, c.b));
  }
  return fmt::format(
      R"svg(<svg class="scale" viewBox="0 0 200 12" preserveAspectRatio="none" aria-hidden="true"
focusable="false"><defs><linearGradient id="{}">{}</linearGradient></defs><rect width="200"
height="12" fill="url(#{})"/></svg>)svg",
      id, stops, id);
}

}  // namespace gnomon::compare
