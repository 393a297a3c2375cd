#include "compare/result/figures.h"

#include <algorithm>
#include <cmath>

#include "compare/comparison.h"
#include "compare/result/number_text.h"

namespace gnomon::compare {
namespace {

double pooled_value(const Figure& figure, std::span<const LightFigures> lights, const LightFigures& pooled) {
  using enum Pooling::Kind;
  const auto& [kind, function] = figure.pooling;
  if (kind == derived) return function(pooled);
  if (kind == same) return figure.of(lights.back());
  double all = 0.0, weights = 0.0;
  for (const LightFigures& light : lights) {
    const double value = figure.of(light), weight = kind == sum ? 1.0 : function(light);
    all += kind == root_mean_square ? weight * value * value : weight * value;
    weights += weight;
  }
  if (kind == sum) return all;
  all /= std::max(weights, 1.0);
  return kind == root_mean_square ? std::sqrt(all) : all;
}

}  // namespace

LightFigures pool_lights(std::span<const LightFigures> lights) {
  LightFigures pooled;
  for (const bool derived : {false, true})
    for (const Figure& figure : figures()) {
      const Pooling::Kind kind = figure.pooling.kind;
      if (kind == Pooling::Kind::none || (kind == Pooling::Kind::derived) != derived) continue;
      if (figure.place.optional && std::isnan(figure.of(derived ? pooled : lights.back()))) continue;
      figure.place.set(pooled, pooled_value(figure, lights, pooled));
    }
  return pooled;
}

const Figure* find_measure(std::string_view name) {
  for (const Figure& figure : figures())
    if (!name.empty() && figure.measure.name == name) return &figure;
  return nullptr;
}

std::string_view form_name(FigureForm form) {
  return form == FigureForm::count ? "count" : form == FigureForm::percent ? "percent" : "number";
}

std::string figure_name(const Figure& figure) {
  std::string words(figure.words.empty() ? figure.name() : figure.words);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string measure_words(const Figure& measure) {
  return measure.measure.by_halves ? std::string(measure.mark.words) : figure_name(measure);
}

std::string figure_head(const Figure& figure) {
  return figure_name(figure) + (figure.unit == "texels" ? ", texels" : "");
}

std::string figure_text(const Figure& figure, double value) {
  if (!std::isfinite(value)) return "unknown";
  if (figure.form() == FigureForm::count) return grouped(static_cast<std::uint64_t>(value));
  if (figure.form() == FigureForm::percent) return percent(value);
  return figure.unit == "texels" ? texels_text(value) : plain_number(value);
}

}  // namespace gnomon::compare
