#include "compare/result/threshold.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/comparison.h"
#include "compare/result/figures.h"

namespace gnomon::compare {

std::string threshold_text(const Threshold& t) {
  const std::string name = t.measure == &wrong_and_mean() ? "" : std::string(t.measure->measure.name) + ":";
  if (t.measure->form() == FigureForm::percent) return fmt::format("{}{:.6g}%", name, 100.0 * t.limit);
  return fmt::format("{}{:.6g}{}", name, t.limit, t.measure->unit == "texels" ? "texel" : "");
}

std::string threshold_range(bool filmed) {
  std::string text =
      fmt::format("of --measure; without it a share for wrong pixels and mean error both, such as {}, or ",
                  wrong_and_mean().measure.example);
  std::string_view between;
  for (const bool film : {false, true})
    for (const Figure& figure : figures()) {
      if (figure.measure.name.empty() || (figure.needs == FigureNeeds::film) != film || (film && !filmed))
        continue;
      text += fmt::format("{}{}:{}", between, figure.measure.name, figure.measure.example);
      if (film) text += fmt::format(" ({})", figure.unit);
      between = ", ";
    }
  return text;
}

std::string limit_words(const Threshold& t) {
  return fmt::format(fmt::runtime(t.measure->measure.limit), figure_text(*t.measure, t.limit));
}

std::vector<LightFigures> judged_lights(const Comparison& comparison) {
  if (comparison.world->scene->is_empty_model) return {};
  return {comparison.lights.begin(), comparison.lights.end()};
}

std::string figure_words(const LightFigures& f, const Figure& measure) {
  const auto said = [&f](const Figure& figure) {
    return fmt::format(fmt::runtime(figure.measure.said), figure_text(figure, figure.of(f)));
  };
  if (measure.needs == FigureNeeds::film) return said(measure);
  const std::string text = said(*find_measure("wrong")) + ", " + said(*find_measure("mean"));
  return measure.form() == FigureForm::percent ? text : text + ", " + said(measure);
}

std::uint64_t unknown_pixels(const LightFigures& f, const Figure& measure) {
  return measure.measure.by_halves ? f.pixels.uncertain : f.pixels.uncertain - f.pixels.uncertain_by_samples;
}

bool too_uncertain(const Threshold& t, const LightFigures& f) {
  const std::uint64_t unknown = unknown_pixels(f, *t.measure);
  if (t.measure->unit != "share") return f.pixels.compared == 0 && unknown > 0;
  return static_cast<double>(unknown) > t.limit * static_cast<double>(f.pixels.compared + f.pixels.uncertain);
}

bool exceeds(const Threshold& t, const LightFigures& f) {
  return !(t.measure->of(f) <= t.limit);
}

std::string excess_words(const Threshold& t, const LightFigures& f, std::string_view limit) {
  if (std::isnan(t.measure->of(f)))
    return fmt::format(
        "the {} is not known (texels need a map, and edges that both shadows have), so that {} cannot be "
        "kept",
        measure_words(*t.measure), limit);
  return fmt::format("{}; that is more than {}", figure_words(f, *t.measure), limit);
}

bool says_nothing(const Threshold& t, std::span<const LightFigures> lights) {
  return t.measure->needs != FigureNeeds::film &&
         std::all_of(lights.begin(), lights.end(),
                     [](const LightFigures& f) { return f.pixels.compared + f.pixels.uncertain == 0; });
}

bool is_kept(const Threshold& t, std::span<const LightFigures> lights) {
  return !says_nothing(t, lights) && std::none_of(lights.begin(), lights.end(), [&](const LightFigures& f) {
    return exceeds(t, f) || too_uncertain(t, f);
  });
}

}  // namespace gnomon::compare
