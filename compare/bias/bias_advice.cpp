#include "compare/bias/bias_advice.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/advice/rule.h"
#include "compare/bias/bias_curve.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {
namespace {

bool is_tiny(double texel, double bias) {
  return bias < 0.01 * texel;
}

// "0.5 texel"; tiny numbers say nothing to a reader.
std::string bound_text(double texel, double bias) {
  if (!(texel > 0.0)) return plain_number(bias) + " world units";
  return is_tiny(texel, bias) ? "0.01 texel" : texels_text(bias / texel);
}

// "213 lit pixels stay dark below 2.5 texels".
std::string need_of_lit(const BestBias& best, double texel) {
  const std::uint64_t count = best.lit_pixels_above;
  return fmt::format("{} lit pixel{} dark below {}", grouped(count), count == 1 ? " stays" : "s stay",
                     bound_text(texel, best.needs_more_than));
}

// "97 shadowed pixels are lit even at bias 0".
std::string need_of_shadowed(const BestBias& best, double texel) {
  const std::uint64_t count = best.shadowed_pixels_below;
  const std::string from = best.needs_less_than > 0.0
                               ? fmt::format("from {} on", bound_text(texel, best.needs_less_than))
                               : "even at bias 0";
  return fmt::format("{} shadowed pixel{} lit {}", grouped(count), count == 1 ? " is" : "s are", from);
}

// What the drawing has beside its constant, with which every other constant is tried: " beside the slope bias of 1".
std::string beside_drawn(const raster::Bias& drawn) {
  const std::size_t parts = bias_parts(drawn).size();
  if (parts == 0) return {};
  if (parts > 1) return " beside the other parts of the bias";
  if (drawn.slope != 0.0) return fmt::format(" beside the slope bias of {}", plain_number(drawn.slope));
  if (drawn.caster_slope != 0.0)
    return fmt::format(" beside the casters' slope bias of {}", plain_number(drawn.caster_slope));
  if (drawn.caster_constant != 0.0) return " beside the casters' constant bias";
  if (drawn.normal_offset_texels != 0.0)
    return " beside the normal offset of " + texels_text(drawn.normal_offset_texels);
  return drawn.receiver_plane ? " beside the receiver's plane" : " beside the adaptive bias";
}

// A gain that no figure shows is none to a reader.
bool is_clearly_better(double fraction, double than, const LightComparison& light) {
  return is_worth_advising({fraction, fraction, fraction}, {than, than, than}, light.pixels.compared) &&
         left_text(fraction, light, wrong_and_mean()) != left_text(than, light, wrong_and_mean());
}

// Whether the drawing has the slope bias already, and nothing else beside its constant: then only that one changes.
bool changes_constant_alone(const BiasKind& kind, const raster::Bias& drawn) {
  return kind.of_slope && kind.bias.slope == drawn.slope && kind.bias.caster_slope == drawn.caster_slope &&
         bias_parts(drawn).size() == (drawn.slope == 0.0 ? 0u : 1u);
}

double slope_of(const raster::Bias& bias) {
  return bias.caster_slope != 0.0 ? bias.caster_slope : bias.slope;
}

// Settings that do as well, where there is room beside the one named.
std::string alike_text(const BiasKind& kind, const raster::Bias& drawn) {
  if (!kind.of_slope || changes_constant_alone(kind, drawn) || !(kind.to > 1.2 * slope_of(kind.bias)))
    return {};
  const char* of = kind.bias.caster_slope != 0.0 ? " of casters" : "";
  return std::isfinite(kind.to)
             ? fmt::format("Any slope bias{} from {} to {} does about as well.", of, plain_number(kind.from),
                           plain_number(kind.to))
             : fmt::format("Any slope bias{} from {} on does about as well.", of, plain_number(kind.from));
}

// Of all kinds the best; of a slope bias that is not needed and not set, the constant beside it.
const BiasKind& advised_kind(const LightComparison& light, const raster::Bias& drawn) {
  const BiasKind& best = light.bias_kinds.front();
  if (!best.of_slope || best.from > 0.0 || drawn.slope != 0.0) return best;
  for (const BiasKind& kind : light.bias_kinds)
    if (kind.name == "constant bias" && kind.wrong_fraction <= best.wrong_fraction) return kind;
  return best;
}

// Beside the best kind, where a constant comes to clearly less.
std::string constant_alone(const LightComparison& light, const Figure& measure) {
  const BiasKind& best = light.bias_kinds.front();
  for (const BiasKind& kind : light.bias_kinds)
    if (kind.name == "constant bias" && is_clearly_better(best.wrong_fraction, kind.wrong_fraction, light))
      return fmt::format("With a constant bias alone: {}.", left_text(kind.wrong_fraction, light, measure));
  return {};
}

/// What a constant in world units is in texels, where that is more than rounding.
std::string in_texels(const raster::Bias& bias, const LightComparison& light) {
  const double texels = bias.constant / light.bias_texel_world;
  if (bias.unit != raster::BiasUnit::world || !std::isfinite(texels) || std::abs(texels) < 0.01) return {};
  return fmt::format(" (a bias of {})", texels_text(texels));
}

BiasAdvice try_bias(const raster::Bias& bias, const std::string& left, const LightComparison& light,
                    const raster::MapOptions& drawn) {
  return {.best = fmt::format("Try {}: {}{}.", bias_arguments(bias, drawn), left, in_texels(bias, light))};
}

BiasAdvice advice_of_kinds(const LightComparison& light, const raster::MapOptions& drawn,
                           const Figure& measure) {
  const BiasKind& best = advised_kind(light, drawn.bias);
  if (!is_clearly_better(best.wrong_fraction, light.error.wrong_fraction, light))
    return {.none = "No other bias does clearly better."};
  BiasAdvice advice = try_bias(best.bias, left_text(best.wrong_fraction, light, measure), light, drawn);
  advice.more = joined_sentences({alike_text(best, drawn.bias), constant_alone(light, measure)});
  return advice;
}

/// More pixels come right than a bias has a part in: it lifts shadows off their casters, which texels that lie elsewhere had
/// put there.
bool lifts_more_than_it_mends(double fraction, const LightComparison& light) {
  double mendable = 0.0;
  for (const Label label :
       {Label::acne, Label::stored_depth, Label::peter_panning, Label::light_leak, Label::caster_bias})
    mendable += static_cast<double>(light.classes[static_cast<std::size_t>(label) - 1]);
  const double gain = light.error.wrong_fraction - fraction;
  return gain * static_cast<double>(light.pixels.compared) > mendable;
}

BiasAdvice advice_of_constants(const LightComparison& light, const raster::MapOptions& drawn,
                               const Figure& measure) {
  const LikelyBias best = likeliest_bias(light, drawn);
  if (lifts_more_than_it_mends(best.wrong_fraction, light)) return {};
  if (is_clearly_better(best.wrong_fraction, light.error.wrong_fraction, light))
    return try_bias(best.bias, left_text(best.wrong_fraction, light, measure), light, drawn);
  if (best.wrong_fraction > light.error.wrong_fraction) return {};
  return {.none = best.wrong_fraction == light.error.wrong_fraction
                      ? "No other constant bias does better."
                      : "No other constant bias does clearly better."};
}

}  // namespace

LikelyBias likeliest_bias(const LightComparison& light, const raster::MapOptions& drawn) {
  if (!light.bias_kinds.empty()) {
    const BiasKind& best = advised_kind(light, drawn.bias);
    return {best.bias, best.wrong_fraction};
  }
  const BestBias::Setting best = light.best_bias.advised();
  return {with_three_digits(with_constant(drawn, best.constant_world, light.bias_texel_world)),
          best.wrong_fraction};
}

bool gaps_tell(const LightFigures& light, const Figure& measure) {
  return counts_biases(light, measure) && light.error.fractional == 0;
}

bool counts_biases(const LightFigures& light, const Figure& measure) {
  return measure.measure.by_halves || (&measure == find_measure("mean") && light.error.fractional == 0);
}

std::string left_text(double fraction, const LightComparison& light, const Figure& measure) {
  if (!measure.measure.by_halves)
    return fmt::format(fmt::runtime(measure.measure.said), figure_text(measure, fraction));
  if (fraction == 0.0) return "none wrong";
  if (fraction >= few_fraction) return percent(fraction) + " wrong";
  return counted(wrong_pixels(fraction, light), "pixel") + " wrong";
}

std::uint64_t wrong_pixels(double fraction, const LightComparison& light) {
  return static_cast<std::uint64_t>(std::llround(fraction * static_cast<double>(light.pixels.compared)));
}

std::string contradiction(const BestBias& best, double texel, const raster::Bias& drawn) {
  if (best.needs_less_than == -infinity)
    return "Bias cannot fix the rest: some shadowed pixels find no caster in the map.";
  const std::string shadowed = need_of_shadowed(best, texel);
  if (!(best.needs_less_than > 0.0)) return fmt::format("Bias cannot fix the rest: {}.", shadowed);
  return fmt::format("No constant bias{} fits all: {}, and {}.", beside_drawn(drawn),
                     need_of_lit(best, texel), shadowed);
}

bool names_both_bounds(const BestBias& best) {
  return !best.feasible && best.needs_more_than > 0.0 && best.needs_less_than > 0.0;
}

BiasAdvice bias_advice(const LightComparison& light, const raster::MapOptions& drawn, const Figure& measure) {
  const BestBias& best = light.best_bias;
  BiasAdvice advice;
  if (light.error.wrong > 0 && gaps_tell(light, measure))
    advice = light.bias_kinds.empty() ? advice_of_constants(light, drawn, measure)
                                      : advice_of_kinds(light, drawn, measure);
  if (!best.feasible)
    advice.more = joined_sentences({advice.more, contradiction(best, light.bias_texel_world, drawn.bias)});
  return advice;
}

}  // namespace gnomon::compare
