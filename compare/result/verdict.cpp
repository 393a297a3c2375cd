#include "compare/result/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compare/advice/candidates.h"
#include "compare/advice/rule.h"
#include "compare/advice/tried.h"
#include "compare/bias/bias_advice.h"
#include "compare/bias/bias_curve.h"
#include "compare/ladder/labels.h"
#include "compare/result/figures.h"
#include "compare/result/judged.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/text_layout.h"

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

/// Those that are off by exactly one half count half, but have no label.
std::string labels_of_wrong(const LightComparison& light) {
  return main_reasons(light.classes, light.error.wrong == 1 || light.error.ties > 0 ? "" : "all of them ");
}

// "Shadow error 4.1 % of the pixels, mostly acne." Each is wholly wrong, so the share is the mean error.
std::string yes_or_no_part(const LightComparison& light) {
  const std::uint64_t compared = light.pixels.compared;
  if (light.error.wrong == 0 && compared == 1) return "No shadow error: the one pixel compared is right.";
  if (light.error.wrong == 0)
    return fmt::format("No shadow error: all {} pixels compared are right.", grouped(compared));
  const std::string share =
      light.error.wrong_fraction < few_fraction
          ? fmt::format("in {} of {} pixels", grouped(wrong_pixels(light.error.wrong_fraction, light)),
                        grouped(compared))
          : percent(light.error.wrong_fraction) + " of the pixels";
  return fmt::format("Shadow error {}, {}.", share, labels_of_wrong(light));
}

/// Where none is off by more than one half, though some by exactly that: "7 pixels are off by exactly one half".
std::string none_more_than_half(const LightComparison& light) {
  if (light.error.ties == 0) return "no pixel is off by more than one half";
  return counted(light.error.ties, "pixel") + (light.error.ties == 1 ? " is" : " are") +
         " off by exactly one half";
}

// Where something is partly lit, in truth or as drawn, counts of what is more than one half off say little.
std::string fractional_part(const LightComparison& light) {
  const auto& errors = light.class_errors;
  const bool labelled = std::any_of(errors.begin(), errors.end(), [](double error) { return error > 0.0; });
  return fmt::format("Shadow error {} on average{}; {}.", percent(light.error.mean_absolute),
                     labelled ? ", " + main_reasons(errors, "all of it ") : std::string(),
                     light.error.wrong == 0 ? none_more_than_half(light)
                                            : left_text(light.error.wrong_fraction, light, wrong_and_mean()));
}

/// The middle of penumbras is left out with few samples, and with it the largest soft errors.
bool hides_soft_errors(const LightFigures& light) {
  constexpr std::uint64_t noticed = 5;  // the least share that changes what is said: one of so many
  const std::uint64_t left_out = light.pixels.uncertain_by_samples;
  return left_out > 0 && noticed * left_out >= left_out + light.error.fractional;
}

std::string uncertain_part(const Comparison& c, const LightComparison& light) {
  const PixelCounts& p = light.pixels;
  if (true_record(c, light).samples == 1)
    return "One sample of the light is no truth, and how far off it is cannot be told: use more --samples.";
  if (p.uncertain == 0) return {};
  return fmt::format(
      "{} more ({}) {} uncertain: the truth there lies within its own error bound.{}", grouped(p.uncertain),
      percent(static_cast<double>(p.uncertain) / static_cast<double>(p.compared + p.uncertain)),
      p.uncertain == 1 ? "is" : "are",
      hides_soft_errors(light)
          ? " With so few samples the middle of penumbras is left out, where soft errors are "
            "largest: use more --samples."
          : "");
}

/// "Shadow error: mean FLIP 0.078; 4.7 % of the pixels wrong, mostly aliasing."
std::string measured_part(const LightComparison& light, const Figure& measure) {
  const double figure = measure.of(light);
  const std::string said =
      std::isnan(figure) ? fmt::format("{} not known", figure_name(measure))
                         : fmt::format(fmt::runtime(measure.measure.said), figure_text(measure, figure));
  if (light.error.wrong == 0)
    return fmt::format("Shadow error: {}; {}.", said,
                       light.error.fractional > 0 ? none_more_than_half(light) : "no pixel is wrong");
  return fmt::format("Shadow error: {}; {} of the pixels wrong, {}.", said,
                     percent(light.error.wrong_fraction), labels_of_wrong(light));
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

// "about 1.2 % on average, 0.3 % wrong", "none wrong", "mean FLIP 0.078": what an advice leaves of a light. `partly_lit`:
// something is, now or then.
std::string left_words(const Left& left, bool about, bool partly_lit, const LightComparison& light,
                       const Figure& measure) {
  const std::string guess = about ? "about " : "";
  if (!measure.measure.by_halves)
    return fmt::format(fmt::runtime(measure.measure.said), guess + figure_text(measure, left.measured));
  const std::string wrong = left_text(left.wrong_fraction, light, measure);
  const bool in_the_mean = partly_lit && &measure == &wrong_and_mean();
  return guess + (in_the_mean ? percent(left.mean_absolute) + " on average, " : "") + wrong;
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
  const Left left{last.wrong_instead, mean_instead, by_wrong ? last.wrong_instead : mean_instead};
  const Left now{last.wrong_now, mean_now, by_wrong ? last.wrong_now : mean_now};
  if (!is_worth_advising(left, now, light.pixels.compared)) return {};
  std::string settings;
  if (last.instead != last.now) settings = instead_text(last);
  if (last.with && last.with->instead != last.with->now)
    settings += (settings.empty() ? "" : " and ") + instead_text(*last.with);
  for (const AdvisedSetting& layer : last.layers)
    if (layer.instead != layer.now) settings += (settings.empty() ? "" : " and ") + instead_text(layer);
  if (last.texels_of_each)
    settings = fmt::format("a bias of {} on each layer, {}", texels_text(*last.texels_of_each, 3), settings);
  if (const std::string own = in_engine_text(judged, last); !own.empty()) settings += " (" + own + ")";
  return fmt::format("Try {}: {}.", settings,
                     left_words(left, last.about, light.error.fractional > 0, light, measure));
}

std::string try_text(const Comparison& c, const LightComparison& light, TriedKind kind) {
  const TriedSetting* tried = best_tried(c, light, kind);
  if (tried == nullptr) return {};
  const LightFigures& left = left_of(*tried, light);
  const bool partly_lit = left.error.fractional + light.error.fractional > 0;
  const std::string leaves = left_words(left_by(left, *c.measure), false, partly_lit, light, *c.measure);
  if (kind == TriedKind::smaller_map)
    return fmt::format("A map of {0} would do (--map-size {0}): its shadow edges are off by {1} pixel, {2}.",
                       tried->map.size, plain_number(rounded_to_three(left.edges.rms_pixels)), leaves);
  return fmt::format("Try {}: {}.", changed_arguments(tried->map, asked_options(c)), leaves);
}

std::string window_advice(const LightComparison& light) {
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
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
  if (!biases_follow_from_gaps(c.raster) || !counts_biases(light, *c.measure)) return {};
  return bias_advice(light, c.raster.options.map, *c.measure);
}

/// Everything that helps, one sentence for each.
std::string what_helps(const Comparison& c, const LightComparison& light, const BiasAdvice& bias) {
  if (lacks_light_size(c.raster, light))
    return joined_sentences(
        {try_text(c, light, TriedKind::other), "The error is mostly the light's size, which no bias mends."});
  if (lacks_window(c, light)) return window_advice(light);
  return joined_sentences({try_text(c, light, TriedKind::smaller_map),
                           try_text(c, light, TriedKind::larger_map), bias.best,
                           try_text(c, light, TriedKind::other)});
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
  const std::string error = error_part(light, *c.measure), uncertain = uncertain_part(c, light);
  if (c.judged) return {error, judged_advice(*c.judged, light, *c.measure), uncertain, uncertain};
  const BiasAdvice bias = advised_bias(c, light);
  const bool told = counts_biases(light, *c.measure) || !c.tried.empty() || c.measure == find_measure("mean");
  std::string better = what_helps(c, light, bias);
  if (better.empty()) better = told ? bias.none : untold(light, *c.measure);
  return {error, better, uncertain, joined_sentences({uncertain, bias.more})};
}

}  // namespace gnomon::compare
