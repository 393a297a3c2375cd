// The bias curves of all kinds in one drawing: lines told apart by colour, dashes and their names.
#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "report/charts.h"
#include "report/html.h"
#include "studies/tune/page.h"

namespace gnomon::compare {
namespace {

constexpr double width = 980.0, height = 360.0;  // SVG units
constexpr double margin_left = 58.0, margin_right = 342.0, margin_top = 20.0, margin_bottom = 48.0;
constexpr double leader = 16.0;        // from a line's end to its name
constexpr double most_texels = 4.0;    // of bias, on the chart
constexpr std::size_t most_lines = 6;  // line-0 … in report.css

struct Line {
  const FamilyResult* family;
  const Attempt* attempt;
  double end_y, label_y;
};

double share(const Attempt& a, const BiasCurvePoint& p) {
  return static_cast<double>(p.false_shadow + p.missed_shadow) /
         static_cast<double>(std::max<std::uint64_t>(a.compared, 1));
}

class Chart {
 public:
  explicit Chart(const TuneResult& result) {
    for (const FamilyResult& family : result.families) {
      const Attempt& attempt = family.answer ? *family.answer : family.closest;
      if (attempt.curve.size() < 2 || !(attempt.texel_world > 0.0)) continue;
      lines_.push_back({&family, &attempt, 0.0, 0.0});
    }
    keep_nearest();
    for (const Line& l : lines_) {
      const Attempt& attempt = *l.attempt;
      // The worst that stands on a curve beyond its beginning sets the scale: a bias of 0 would flatten all.
      for (const BiasCurvePoint& p : attempt.curve)
        if (p.bias >= 0.25 * attempt.texel_world) highest_ = std::max(highest_, share(attempt, p));
    }
    highest_ = std::max(1.05 * highest_, 1e-9);
  }

  std::string text() {
    if (lines_.empty()) return {};
    place_labels();
    std::string svg = fmt::format(
        R"(<svg class="chart" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="Wrong pixels against the constant bias, a line for each kind">)",
        width, height);
    svg += fmt::format(
        R"(<defs><clipPath id="tune-clip"><rect x="{:.0f}" y="{:.0f}" width="{:.0f}" height="{:.0f}"/></clipPath></defs>)",
        margin_left, margin_top, width - margin_left - margin_right, height - margin_top - margin_bottom);
    svg += axes();
    for (std::size_t i = 0; i < lines_.size(); ++i) svg += line(i);
    return svg + "</svg>";
  }

 private:
  /// What is good enough, by its cost, and then the rest, by its error; more lines could not be told apart.
  void keep_nearest() {
    std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) {
      const bool good = a.family->answer.has_value(), also = b.family->answer.has_value();
      if (good != also) return good;
      return good ? a.attempt->cost < b.attempt->cost : a.attempt->error < b.attempt->error;
    });
    lines_.resize(std::min(lines_.size(), most_lines));
  }

  double x(double texels) const {
    return margin_left + texels / most_texels * (width - margin_left - margin_right);
  }
  double y(double wrong) const {
    return height - margin_bottom - std::min(wrong / highest_, 2.0) * (height - margin_top - margin_bottom);
  }

  std::string axes() const {
    std::string out;
    for (const double v : nice_ticks(0.0, highest_, 4))
      out += fmt::format(
          R"(<line class="grid" x1="{:.0f}" x2="{:.0f}" y1="{:.1f}" y2="{:.1f}"/><text class="tick end" x="{:.0f}" y="{:.1f}">{:.3g} %</text>)",
          margin_left, width - margin_right, y(v), y(v), margin_left - 8, y(v) + 4, 100.0 * v);
    for (const double v : nice_ticks(0.0, most_texels, 4))
      out += fmt::format(R"(<text class="tick middle" x="{:.1f}" y="{:.0f}">{:.3g}</text>)", x(v),
                         height - margin_bottom + 20, v);
    return out + fmt::format(R"(<text class="tick middle" x="{:.0f}" y="{:.0f}">bias, texels</text>)",
                             (margin_left + width - margin_right) / 2, height - 8);
  }

  // The names stand at the lines' right ends, moved apart.
  void place_labels() {
    std::vector<Line*> order;
    for (Line& l : lines_) {
      l.end_y = l.label_y = std::max(margin_top, y(share(*l.attempt, last_shown(*l.attempt))));
      order.push_back(&l);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const Line* a, const Line* b) { return a->label_y < b->label_y; });
    constexpr double spacing = 17.0;
    for (std::size_t i = 0; i < order.size(); ++i)
      order[i]->label_y =
          std::max(order[i]->label_y, i == 0 ? margin_top + 8 : order[i - 1]->label_y + spacing);
    const double excess = std::max(0.0, order.back()->label_y - (height - margin_bottom));
    for (Line* l : order) l->label_y -= excess;
  }

  static const BiasCurvePoint& last_shown(const Attempt& a) {
    const auto beyond = std::find_if(a.curve.begin() + 1, a.curve.end(), [&a](const BiasCurvePoint& p) {
      return p.bias > most_texels * a.texel_world;
    });
    return *(beyond - 1);
  }

  std::string line(std::size_t i) const {
    const Line& l = lines_[i];
    std::string points;
    for (const BiasCurvePoint& p : l.attempt->curve)
      if (p.bias <= most_texels * l.attempt->texel_world * (1.0 + 1e-9))
        fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ", x(p.bias / l.attempt->texel_world),
                       y(share(*l.attempt, p)));
    const std::string style = fmt::format("line-{}", i);
    return fmt::format(
        R"svg(<g clip-path="url(#tune-clip)"><polyline class="curve {0}" points="{1}"/></g><circle class="{0}" cx="{2:.1f}" cy="{3:.1f}" r="4"/><polyline class="curve {0}" points="{4:.0f},{5:.1f} {6:.0f},{7:.1f}"/><text class="name" x="{8:.0f}" y="{9:.1f}">{10}</text>)svg",
        style, points,
        x(std::clamp(l.attempt->best.constant_world / l.attempt->texel_world, 0.0, most_texels)),
        y(l.attempt->best.wrong_fraction), width - margin_right, l.end_y, width - margin_right + leader,
        l.label_y, width - margin_right + leader + 6.0, l.label_y + 4,
        escaped(fmt::format("{} ({})", l.family->family.name, l.attempt->size)));
  }

  std::vector<Line> lines_;
  double highest_ = 0.0;
};

}  // namespace

std::string tune_chart(const TuneResult& result) {
  return Chart(result).text();
}

}  // namespace gnomon::compare
