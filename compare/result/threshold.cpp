#include "compare/result/threshold.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/comparison.h"
#include "compare/result/number_text.h"

namespace gnomon::compare {

std::string_view measure_name(ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::wrong_and_mean:
      return "wrong and mean";
    case ErrorMeasure::wrong:
      return "wrong";
    case ErrorMeasure::mean:
      return "mean";
    case ErrorMeasure::flip:
      return "flip";
    case ErrorMeasure::edge:
      return "edge";
    case ErrorMeasure::shimmer:
      return "shimmer";
  }
  return "";
}

std::string threshold_text(const Threshold& t) {
  switch (t.measure) {
    case ErrorMeasure::wrong_and_mean:
      return fmt::format("{:.6g}%", 100.0 * t.limit);
    case ErrorMeasure::flip:
      return fmt::format("flip:{:.6g}", t.limit);
    case ErrorMeasure::edge:
      return fmt::format("edge:{:.6g}texel", t.limit);
    case ErrorMeasure::shimmer:
      return fmt::format("shimmer:{:.6g}", t.limit);
    default:
      return fmt::format("{}:{:.6g}%", measure_name(t.measure), 100.0 * t.limit);
  }
}

std::string limit_words(const Threshold& t) {
  switch (t.measure) {
    case ErrorMeasure::wrong_and_mean:
      return fmt::format("at most {} wrong, and a mean error of at most as much", percent(t.limit));
    case ErrorMeasure::wrong:
      return fmt::format("at most {} wrong", percent(t.limit));
    case ErrorMeasure::mean:
      return fmt::format("a mean error of at most {}", percent(t.limit));
    case ErrorMeasure::flip:
      return fmt::format("a mean FLIP of at most {}", plain_number(t.limit));
    case ErrorMeasure::edge:
      return fmt::format("shadow edges displaced by at most {} (RMS)", texels_text(t.limit));
    case ErrorMeasure::shimmer:
      return fmt::format("at most {} flips per receiver and second", plain_number(t.limit));
  }
  return {};
}

ErrorFigures figures_of(const LightComparison& light) {
  return {
      light.error.wrong_fraction,
      light.error.mean_absolute,
      light.error.flip,
      light.edges.rms_texels,
      light.pixels.compared,
      light.pixels.uncertain,
      light.pixels.uncertain_by_samples,
      light.shimmer ? light.shimmer->flips_per_receiver_second : std::numeric_limits<double>::quiet_NaN()};
}

std::vector<ErrorFigures> figures_of(const Comparison& comparison) {
  std::vector<ErrorFigures> lights;
  if (comparison.world->scene->is_empty_model) return lights;
  for (const LightComparison& light : comparison.lights) lights.push_back(figures_of(light));
  return lights;
}

double figure(const ErrorFigures& f, ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::wrong_and_mean:
      return std::max(f.wrong_fraction, f.mean_absolute);
    case ErrorMeasure::wrong:
      return f.wrong_fraction;
    case ErrorMeasure::mean:
      return f.mean_absolute;
    case ErrorMeasure::flip:
      return f.flip;
    case ErrorMeasure::edge:
      return f.edge_rms_texels;
    case ErrorMeasure::shimmer:
      return f.flips_per_second;
  }
  return 0.0;
}

std::string figure_words(const ErrorFigures& f, ErrorMeasure measure) {
  if (measure == ErrorMeasure::shimmer)
    return plain_number(f.flips_per_second) + " flips per receiver and second";
  std::string text =
      fmt::format("{} wrong, mean error {}", percent(f.wrong_fraction), percent(f.mean_absolute));
  if (measure == ErrorMeasure::flip) text += ", mean FLIP " + plain_number(f.flip);
  if (measure == ErrorMeasure::edge) text += ", edges off by " + texels_text(f.edge_rms_texels) + " (RMS)";
  return text;
}

std::uint64_t unknown_pixels(const ErrorFigures& f, ErrorMeasure measure) {
  const bool by_halves = measure == ErrorMeasure::wrong || measure == ErrorMeasure::wrong_and_mean;
  return by_halves ? f.uncertain : f.uncertain - f.uncertain_by_samples;
}

bool too_uncertain(const Threshold& t, const ErrorFigures& f) {
  const std::uint64_t unknown = unknown_pixels(f, t.measure);
  if (t.measure == ErrorMeasure::edge || t.measure == ErrorMeasure::shimmer)
    return f.compared == 0 && unknown > 0;
  return static_cast<double>(unknown) > t.limit * static_cast<double>(f.compared + f.uncertain);
}

bool exceeds(const Threshold& t, const ErrorFigures& f) {
  return !(figure(f, t.measure) <= t.limit);
}

bool says_nothing(const Threshold& t, std::span<const ErrorFigures> lights) {
  return t.measure != ErrorMeasure::shimmer &&
         std::all_of(lights.begin(), lights.end(),
                     [](const ErrorFigures& f) { return f.compared + f.uncertain == 0; });
}

bool is_kept(const Threshold& t, std::span<const ErrorFigures> lights) {
  return !says_nothing(t, lights) && std::none_of(lights.begin(), lights.end(), [&](const ErrorFigures& f) {
    return exceeds(t, f) || too_uncertain(t, f);
  });
}

}  // namespace gnomon::compare
