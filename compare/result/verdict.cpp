#include "compare/result/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compare/advice/rule.h"
#include "compare/bias/bias_advice.h"
#include "compare/bias/bias_curve.h"
#include "compare/ladder/labels.h"
#include "compare/result/figures.h"
#include "compare/result/judged.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/text_layout.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

/// "all of them acne", "mostly acne", "mainly acne and aliasing": the labels with most of what is off, by count or by size.
template <class Amount>
std::string main_reasons(const std::array<Amount, class_count>& amounts, std::string_view all_of) {
  std::array<std::size_t, class_count> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return amounts[a] > amounts[b]; });
  const auto name = [&](std::size_t rank) {
    return std::string(label_text(static_cast<Label>(order[rank] + 1)).name);
  };
  const auto amount = [&](std::size_t rank) { return amounts[order[rank]]; };
  const Amount sum = std::accumulate(amounts.begin(), amounts.end(), Amount{});
  if (!(amount(1) > Amount{})) return fmt::format("{}{}", all_of, name(0));
  if (2 * amount(0) > sum) return "mostly " + name(0);
  if (2 * (amount(0) + amount(1)) > sum) return fmt::format("mainly {} and {}", name(0), name(1));
  return fmt::format("mainly {}, {} and {}", name(0), name(1), name(2));
}

// "Shadow error 4.1 % of the pixels, mostly acne." Each is wholly wrong, so the share is the mean error.
std::string yes_or_no_part(const LightComparison& light) {
  const std::uint64_t wrong = light.error.wrong, compared = light.pixels.compared;
  if (wrong == 0 && compared == 1) return "No shadow error: the one pixel compared is right.";
  if (wrong == 0) return fmt::format("No shadow error: all {} pixels compared are right.", grouped(compared));
  const std::string share = light.error.wrong_fraction < few_fraction
                                ? fmt::format("in {} of {} pixels", grouped(wrong), grouped(compared))
                                : percent(light.error.wrong_fraction) + " of the pixels";
  return fmt::format("Shadow error {}, {}.", share,
                     main_reasons(light.classes, wrong == 1 ? "" : "all of them "));
}

// Where something is partly lit, in truth or as drawn, counts of what is more than one half off say little.
std::string fractional_part(const LightComparison& light) {
  const std::uint64_t wrong = light.error.wrong, compared = light.pixels.compared;
  const auto& errors = light.class_errors;
  const bool labelled = std::any_of(errors.begin(), errors.end(), [](double error) { return error > 0.0; });
  const std::string lead = fmt::format("Shadow error {} on average{}; ", percent(light.error.mean_absolute),
                                       labelled ? ", " + main_reasons(errors, "all of it ") : std::string());
  if (wrong == 0) return lead + "no pixel is off by more than one half.";
  // Without those that are off by exactly one half, of which the figure of the error counts half.
  const double share = static_cast<double>(wrong) / static_cast<double>(compared);
  if (share >= few_fraction)
    return fmt::format("{}{} of the pixels are off by more than one half.", lead, percent(share));
  return fmt::format("{}{} pixel{} off by more than one half.", lead, grouped(wrong),
                     wrong == 1 ? " is" : "s are");
}

std::string uncertain_part(const PixelCounts& p) {
  if (p.uncertain == 0) return {};
  return fmt::format(
      "{} more ({}) {} uncertain: the truth there lies within its own error bound.", grouped(p.uncertain),
      percent(static_cast<double>(p.uncertain) / static_cast<double>(p.compared + p.uncertain)),
      p.uncertain == 1 ? "is" : "are");
}

// Most of the error is that a light with size was taken for its centre: no filter makes up for most of that, and no other
// step or label stands for more of the error.
bool lacks_light_size(const raster::RasterFrame& drawn, const LightComparison& light) {
  if (drawn.custom_shader || raster::traits_of(drawn.options.map.technique).soft) return false;
  const auto step = [&](Cause cause) { return light.budget[static_cast<std::size_t>(cause)]; };
  const double shrunk = step(Cause::light_size).absolute_mean, error = light.error.mean_absolute;
  if (light.error.fractional == 0 || shrunk < 0.5 * error || error < 0.5 * shrunk) return false;
  const double biased =  // what the bias leaves of the map's acne, or adds
      step(Cause::slope).signed_mean + step(Cause::precision).signed_mean + step(Cause::bias).signed_mean;
  const double others =
      std::max({step(Cause::filter).absolute_mean, step(Cause::sampling).absolute_mean, std::abs(biased)});
  const double by_size = light.class_errors[static_cast<std::size_t>(Label::light_size) - 1];
  return shrunk > others &&
         by_size >= *std::max_element(light.class_errors.begin(), light.class_errors.end());
}

std::string soft_technique_advice() {
  std::string options;
  for (const raster::TechniqueTraits& t : raster::all_technique_traits())
    if (t.soft) options += fmt::format("{}--technique {}", options.empty() ? "" : " or ", t.name);
  return fmt::format("Try {}: the error is mostly the light's size, which no bias mends.", options);
}

/// "Shadow error: mean FLIP 0.078; 4.7 % of the pixels wrong, mostly aliasing."
std::string measured_part(const LightComparison& light, const Figure& measure) {
  const double figure = measure.of(light);
  const std::string said =
      std::isnan(figure) ? fmt::format("{} not known", figure_name(measure))
                         : fmt::format(fmt::runtime(measure.measure.said), figure_text(measure, figure));
  if (light.error.wrong == 0)
    return fmt::format("Shadow error: {}; no pixel {}.", said,
                       light.error.fractional > 0 ? "is off by more than one half" : "is wrong");
  return fmt::format("Shadow error: {}; {} of the pixels wrong, {}.", said,
                     percent(light.error.wrong_fraction), main_reasons(light.classes, "all of them "));
}

/// Where nobody chose a measure, pixels are counted, or errors averaged where something is partly lit.
std::string error_part(const LightComparison& light, const Figure& measure) {
  const bool partly_lit = light.error.fractional > 0;
  if (&measure == &wrong_and_mean()) return partly_lit ? fractional_part(light) : yes_or_no_part(light);
  if (&measure == find_measure("mean") && (partly_lit || light.error.wrong > 0))
    return fractional_part(light);
  return &measure == find_measure("wrong") && (!partly_lit || light.error.wrong > 0)
             ? yes_or_no_part(light)
             : measured_part(light, measure);
}

std::string nothing_compared(const PixelCounts& p, LightType light) {
  const std::string one = p.facing_away == 1 ? "s" : "";
  const std::string away = fmt::format("{} face{} away from the light", grouped(p.facing_away), one);
  return fmt::format(
      "No pixel could be compared: of {}, {} show{} no surface, {}, {} {} and {} {} uncertain.",
      grouped(p.total), grouped(p.background), p.background == 1 ? "s" : "",
      light == LightType::spot ? fmt::format("{} or lie{} outside its cone", away, one) : away,
      grouped(p.silhouette), p.silhouette == 1 ? "is a silhouette" : "are silhouettes", grouped(p.uncertain),
      p.uncertain == 1 ? "is" : "are");
}

template <class Setting>
std::string instead_text(const Setting& one) {
  return fmt::format("{} {:.4g} instead of {:.4g}", one.setting, one.instead, one.now);
}

// "about 1.2 % on average, 0.3 % wrong", "none wrong": what the advice for another renderer leaves.
std::string left_by_advice(const Advice& advice, const LightComparison& light, const Figure& measure) {
  const double mean = advice.mean_instead.value_or(advice.wrong_instead);
  const std::string about = advice.about ? "about " : "";
  if (&measure == find_measure("mean"))
    return fmt::format(fmt::runtime(measure.measure.said), about + percent(mean));
  const std::string wrong = left_text(advice.wrong_instead, light, measure);
  if (measure.measure.by_halves && &measure != &wrong_and_mean()) return about + wrong;
  return about + (light.error.fractional > 0 ? percent(mean) + " on average, " : "") + wrong;
}

// Of another renderer's picture, in that renderer's own units; no option of Gnomon's own can be set there. First comes
// the constant alone, and where another setting does clearly better that one and the constant beside it.
std::string judged_advice(const Judged& judged, const LightComparison& light, const Figure& measure) {
  if (!judged.cure.empty() || judged.advice.empty()) return judged.cure;
  const Advice& last = judged.advice.back();
  const bool mean = &measure == find_measure("mean");
  if (!mean && !measure.measure.by_halves)
    return fmt::format("Only a drawing tells what another bias does to the {}.", measure_words(measure));
  const double mean_now = last.mean_now.value_or(last.wrong_now),
               mean_instead = last.mean_instead.value_or(last.wrong_instead);
  const bool by_wrong = !mean && (&measure != &wrong_and_mean() || light.error.fractional == 0);
  if (!is_worth_advising({last.wrong_instead, mean_instead, by_wrong ? last.wrong_instead : mean_instead},
                         {last.wrong_now, mean_now, by_wrong ? last.wrong_now : mean_now},
                         light.pixels.compared))
    return {};
  std::string settings;
  if (last.instead != last.now) settings = instead_text(last);
  if (last.with && last.with->instead != last.with->now)
    settings += (settings.empty() ? "" : " and ") + instead_text(*last.with);
  for (const AdvisedSetting& layer : last.layers)
    if (layer.instead != layer.now) settings += (settings.empty() ? "" : " and ") + instead_text(layer);
  if (last.texels_of_each)
    settings = fmt::format("a bias of {:.3g} texels on each layer, {}", *last.texels_of_each, settings);
  if (const std::string own = in_engine_text(judged, last); !own.empty()) settings += " (" + own + ")";
  return fmt::format("Try {}: {}.", settings, left_by_advice(last, light, measure));
}

/// "about 2.6 % wrong", "mean error about 2.6 %": what an estimate of the mean error leaves.
std::string about_text(double error, const LightComparison& light, const Figure& measure) {
  const std::string about = "about " + percent(error);
  if (&measure == find_measure("mean")) return fmt::format(fmt::runtime(measure.measure.said), about);
  return about + (light.error.fractional > 0 ? " on average" : " wrong");
}

// Estimates are of the mean error, which is the share of wrong pixels where nothing is partly lit.
bool counts_sizes(const LightComparison& light, const Figure& measure) {
  return &measure == &wrong_and_mean() || &measure == find_measure("mean") ||
         (measure.measure.by_halves && light.error.fractional == 0);
}

// A map of another size is worth a sentence where the error falls by a fifth, by more than the estimate may be off; or,
// where there is hardly an error, the smallest that leaves hardly one.
std::string size_advice(const LightComparison& light, int drawn_size, const Figure& measure) {
  if (!counts_sizes(light, measure)) return {};
  constexpr double hardly_an_error = 0.005, clear_gain = 0.2, sure = 2.0;
  const double error = light.error.mean_absolute;
  for (const OtherMapSize& other : light.other_sizes) {
    const bool smaller = other.size < drawn_size;
    const double at_most = other.mean_absolute + sure * other.standard_error;
    if (smaller && at_most < hardly_an_error)
      return fmt::format("A map of {0} would do (--map-size {0}: {1}).", other.size,
                         about_text(other.mean_absolute, light, measure));
    if (!smaller && error >= hardly_an_error && at_most < (1.0 - clear_gain) * error)
      return fmt::format("Try --map-size {}: {}.", other.size,
                         about_text(other.mean_absolute, light, measure));
  }
  return {};
}

// Most of what is wrong lies outside a window that was given, where neither a bias nor texels help.
std::string window_advice(const Comparison& c, const LightComparison& light) {
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
  if (c.raster.options.map.window.empty() || 2 * outside <= light.error.wrong) return {};
  return fmt::format("Give the light a larger window: {} of the pixels miss their shadow outside it.",
                     percent(static_cast<double>(outside) / static_cast<double>(light.pixels.compared)));
}

/// Of a measure that nothing but a drawing tells.
std::string untold(const LightComparison& light, const Figure& measure) {
  if (!(measure.of(light) > 0.0)) return {};
  return fmt::format(
      "Only drawings tell what another bias or map does to the {}: gnomon tune --max-error {}:LIMIT makes "
      "them.",
      measure_words(measure), measure.measure.name);
}

// What other biases would do follows from the gaps of a hard test alone.
BiasAdvice advised_bias(const Comparison& c, const LightComparison& light) {
  if (!biases_follow_from_gaps(c.raster)) return {};
  if (counts_biases(light, *c.measure)) return bias_advice(light, c.raster.options.map, *c.measure);
  return {.none = fmt::format("Only a drawing tells what another bias does to the {}.",
                              measure_words(*c.measure))};
}

}  // namespace

std::string Verdict::headline() const {
  return joined_sentences({error, advice});
}

std::string Verdict::whole() const {
  return joined_sentences({error, advice, detail});
}

Verdict verdict_on(const Comparison& c, const LightComparison& light) {
  if (light.pixels.compared == 0)
    return {.error = nothing_compared(light.pixels, c.world->scene->lights[light.light].type)};
  const std::string error = error_part(light, *c.measure), uncertain = uncertain_part(light.pixels);
  if (c.judged) return {error, judged_advice(*c.judged, light, *c.measure), uncertain, uncertain};
  const bool told = counts_sizes(light, *c.measure) || counts_biases(light, *c.measure);
  std::string cause = lacks_light_size(c.raster, light) ? soft_technique_advice() : window_advice(c, light);
  if (!told || !cause.empty())
    return {error, joined_sentences({cause, told ? std::string() : untold(light, *c.measure)}), uncertain,
            uncertain};
  const BiasAdvice bias = advised_bias(c, light);
  const int size = drawn_record(c, light).map.view.size;
  const std::string better = joined_sentences({size_advice(light, size, *c.measure), bias.best});
  return {error, better.empty() ? bias.none : better, uncertain, joined_sentences({uncertain, bias.more})};
}

}  // namespace gnomon::compare
