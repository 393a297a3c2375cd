#include "studies/diff/words.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"

namespace gnomon::studies {
namespace {

using compare::grouped;

}  // namespace

std::string change_text(const FigureChange& change) {
  if (change.trend == Trend::same) return "as before";
  const std::string by = compare::figure_text(*change.figure, std::abs(change.after - change.before));
  const std::string sign = change.after > change.before ? "+" : "\u2212";
  if (change.trend != Trend::untold)
    return fmt::format("{}{}, {}{}", sign, by, trend_name(change.trend),
                       change.in_texels_now ? ", in texels of the map now" : "");
  if (std::isinf(change.spread)) return fmt::format("{}{}; what chance does to it is not known", sign, by);
  return fmt::format("{}{}, no more than the {} of chance", sign, by,
                     compare::figure_text(*change.figure, change.spread));
}

std::string time_text(const std::array<double, 3>& ms) {
  return compare::milliseconds(
      TimeDifference{.pairs = {{ms[0]}}, .low = ms[1], .median = ms[0], .high = ms[2], .told = ms[1] > 0.0});
}

std::string pixels_text(const LightDiff& light) {
  if (!light.pixels) return "not known by pixel: " + light.no_pixels;
  const PixelChange& pixels = *light.pixels;
  std::string text = fmt::format("{} new, {} fixed, {} as before", grouped(pixels.newly_wrong),
                                 grouped(pixels.fixed), grouped(pixels.still));
  if (pixels.uncounted > 0)
    text += fmt::format("; {} more are compared in one result alone", grouped(pixels.uncounted));
  return text;
}

std::string new_labels_text(const LightDiff& light) {
  std::string text;
  for (const LabelChange& label : light.labels)
    if (label.newly_wrong > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", compare::label_text(label.label).name,
                          grouped(label.newly_wrong));
  return text;
}

std::string verdict_text(const Diff& diff) {
  switch (diff.trend) {
    case Trend::same:
      return "as before";
    case Trend::untold:
      return "no change that is more than chance";
    case Trend::better:
      return "better";
    case Trend::worse:
      return "worse";
    case Trend::mixed:
      break;
  }
  return "worse in one way, better in another";
}

std::string diff_text(const Diff& diff) {
  std::string text = fmt::format("{}: {}\n", diff.scene, verdict_text(diff));
  for (const ChangedSetting& setting : diff.changed)
    text += fmt::format("  {:9} {} \u2192 {}\n", setting.key, setting.before, setting.after);
  for (const LightDiff& light : diff.lights) {
    text += fmt::format("{}\n", light.name);
    for (const FigureChange& change : light.figures)
      text += fmt::format("  {:9} {} \u2192 {} ({})\n", change.figure->measure.name,
                          compare::figure_text(*change.figure, change.before),
                          compare::figure_text(*change.figure, change.after), change_text(change));
    text += fmt::format("  {:9} {}\n", "pixels", pixels_text(light));
    if (const std::string labels = new_labels_text(light); !labels.empty())
      text += fmt::format("  {:9} {}\n", "new", labels);
  }
  return text;
}

}  // namespace gnomon::studies
