#include "compare/bias/bias_advice.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {
namespace {

constexpr double clear_gain = 0.05;  // of the wrong pixels, so as to be worth another bias

std::string bias_text(const LightComparison& light, double bias) {
  const std::string world = plain_number(bias) + " world units";
  const double texel = light.bias_texel_world;
  return texel > 0.0 && std::isfinite(bias) ? fmt::format("{} ({})", world, texels_text(bias / texel))
                                            : world;
}

bool is_tiny(double texel, double bias) {
  return bias < 0.01 * texel;
}

// "0.5 texel"; tiny numbers say nothing to a reader.
std::string bound_text(double texel, double bias) {
  if (!(texel > 0.0)) return plain_number(bias) + " world units";
  return is_tiny(texel, bias) ? "a hundredth of a texel" : texels_text(bias / texel);
}

// "213 lit pixels need at least 2 texels"; nothing where they are lit without any.
std::string need_of_lit(const BestBias& best, double texel) {
  if (!(best.needs_more_than > 0.0)) return {};
  const std::string who = fmt::format("{} lit pixel{} ", grouped(best.lit_pixels_above),
                                      best.lit_pixels_above == 1 ? " needs" : "s need");
  const std::string bound = bound_text(texel, best.needs_more_than);
  return who +
         (is_tiny(texel, best.needs_more_than) ? "some, though not " + bound + "," : "at least " + bound) +
         " and ";
}

std::string need_of_shadowed(const BestBias& best, double texel) {
  const std::uint64_t count = best.shadowed_pixels_below;
  if (!(best.needs_less_than > 0.0))
    return fmt::format("{} shadowed pixel{} lit even without one", grouped(count),
                       count == 1 ? " is" : "s are");
  const std::string bound = bound_text(texel, best.needs_less_than);
  const bool said = best.needs_more_than > 0.0 && bound == bound_text(texel, best.needs_more_than);
  return fmt::format("{} shadowed pixel{} less{}", grouped(count), count == 1 ? " needs" : "s need",
                     said ? "" : " than " + bound);
}

// What the drawing has beside its constant, with which every other constant is tried: " beside the slope bias of 1".
std::string beside_drawn(const raster::Bias& drawn) {
  const std::size_t parts = bias_parts(drawn).size();
  if (parts == 0) return {};
  if (parts > 1) return " beside the other parts of the bias";
  if (drawn.slope != 0.0) return fmt::format(" beside the slope bias of {}", plain_number(drawn.slope));
  if (drawn.normal_offset_texels != 0.0)
    return " beside the normal offset of " + texels_text(drawn.normal_offset_texels);
  return drawn.receiver_plane ? " beside the receiver's plane" : " beside the adaptive bias";
}

// "none", "7 of them", "0.8 %".
std::string rest_text(double fraction, const LightComparison& light) {
  if (fraction == 0.0) return "none";
  if (fraction >= few_fraction) return percent(fraction) + (light.error.fractional > 0 ? " wrong" : "");
  return fmt::format("{:.0f} of them", fraction * static_cast<double>(light.pixels.compared));
}

// Where the pixels happen to lie changes a count of wrong ones by about its square root. The best of many biases gains
// as much by that alone.
bool is_more_than_chance(double fraction, double than, const LightComparison& light) {
  const double wrong = than * static_cast<double>(light.pixels.compared);
  const double gain = wrong - fraction * static_cast<double>(light.pixels.compared);
  return gain > 2.0 * std::sqrt(wrong);
}

// A gain that no figure shows is none to a reader, nor is one that only rounding or chance shows.
bool is_clearly_better(double fraction, double than, const LightComparison& light) {
  return fraction < (1.0 - clear_gain) * than && rest_text(fraction, light) != rest_text(than, light) &&
         (fraction == 0.0 || is_more_than_chance(fraction, than, light));
}

// A constant that the kind takes beside it, where that moves shadows by what can be seen.
std::string beside_text(const BiasKind& kind, const LightComparison& light) {
  const double texels = kind.bias.unit == raster::BiasUnit::texel
                            ? kind.bias.constant
                            : kind.bias.constant / light.bias_texel_world;
  const bool seen = kind.bias.unit != raster::BiasUnit::automatic && std::isfinite(texels) && texels >= 1.0;
  return seen ? " with a constant of " + texels_text(texels) : std::string();
}

// "A constant bias of 0.5 texel".
std::string constant_subject(const raster::Bias& bias, const LightComparison& light) {
  if (bias.unit == raster::BiasUnit::automatic) return "A constant bias of no more than rounding needs";
  if (bias.constant == 0.0) return "A constant bias of 0";
  if (bias.unit == raster::BiasUnit::texel) return "A constant bias of " + texels_text(bias.constant);
  const double texel = light.bias_texel_world;
  return (is_tiny(texel, bias.constant) ? "A constant bias of less than " : "A constant bias of ") +
         bound_text(texel, bias.constant);
}

// Whether the drawing has the slope bias already, and nothing else beside its constant: then only that one changes.
bool changes_constant_alone(const BiasKind& kind, const raster::Bias& drawn) {
  return kind.of_slope && kind.bias.slope == drawn.slope &&
         bias_parts(drawn).size() == (drawn.slope == 0.0 ? 0u : 1u);
}

std::string subject(const BiasKind& kind, const LightComparison& light, const raster::Bias& drawn) {
  if (changes_constant_alone(kind, drawn)) return constant_subject(kind.bias, light) + beside_drawn(drawn);
  if (kind.of_slope && kind.bias.slope == 0.0) return "No slope bias";
  if (kind.of_slope) return fmt::format("A slope bias of {}", plain_number(kind.bias.slope));
  if (kind.bias.receiver_plane) return "The receiver's plane" + beside_text(kind, light);
  if (kind.bias.adaptive) return "The adaptive bias" + beside_text(kind, light);
  if (kind.bias.normal_offset_texels != 0.0) return "A normal offset of one texel" + beside_text(kind, light);
  return constant_subject(kind.bias, light);
}

// Settings that do as well, where there is room beside the one named.
std::string alike_text(const BiasKind& kind, const raster::Bias& drawn) {
  if (!kind.of_slope || changes_constant_alone(kind, drawn) || !(kind.to > 1.2 * kind.bias.slope)) return {};
  return std::isfinite(kind.to)
             ? fmt::format("; anything from {} to {} does about as well", plain_number(kind.from),
                           plain_number(kind.to))
             : fmt::format("; anything from {} on does about as well", plain_number(kind.from));
}

// Of all kinds the best; of a slope bias that is not needed and not set, the constant beside it.
const BiasKind& advised_kind(const LightComparison& light, const raster::Bias& drawn) {
  const BiasKind& best = light.bias_kinds.front();
  if (!best.of_slope || best.from > 0.0 || drawn.slope != 0.0) return best;
  for (const BiasKind& kind : light.bias_kinds)
    if (kind.name == "constant bias" && kind.wrong_fraction <= best.wrong_fraction) return kind;
  return best;
}

std::string best_kind(const LightComparison& light, const raster::MapOptions& drawn) {
  const BiasKind& best = advised_kind(light, drawn.bias);
  if (light.error.wrong == 0) return {};
  if (!is_clearly_better(best.wrong_fraction, light.error.wrong_fraction, light))
    return "No other kind of bias does clearly better.";
  return fmt::format("{} ({}{}) would leave {}.", subject(best, light, drawn.bias),
                     bias_arguments(best.bias, drawn), alike_text(best, drawn.bias),
                     rest_text(best.wrong_fraction, light));
}

// Beside the best kind, where a constant comes to clearly less.
std::string constant_alone(const LightComparison& light) {
  const BiasKind& best = light.bias_kinds.front();
  if (light.error.wrong == 0 || !is_clearly_better(best.wrong_fraction, light.error.wrong_fraction, light))
    return {};
  for (const BiasKind& kind : light.bias_kinds)
    if (kind.name == "constant bias" && is_clearly_better(best.wrong_fraction, kind.wrong_fraction, light))
      return fmt::format("A constant bias alone would leave {} at best.",
                         rest_text(kind.wrong_fraction, light));
  return {};
}

std::string constant_part(const LightComparison& light) {
  const BestBias::Setting best = light.best_bias.advised();
  const double drawn = light.error.wrong_fraction;
  if (is_clearly_better(best.wrong_fraction, drawn, light))
    return fmt::format("A constant bias of {} would leave {}.", bias_text(light, best.constant_world),
                       rest_text(best.wrong_fraction, light));
  if (light.error.wrong == 0 || best.wrong_fraction > drawn) return {};
  return best.wrong_fraction == drawn ? "No other constant bias does better."
                                      : "No other constant bias does clearly better.";
}

}  // namespace

std::string contradiction(const BestBias& best, double texel, const raster::Bias& drawn) {
  if (best.needs_less_than == -infinity)
    return "No constant bias can be right everywhere: some shadowed pixels find no caster stored in the map.";
  const std::string needs = need_of_lit(best, texel) + need_of_shadowed(best, texel);
  return fmt::format("No constant bias{} can be right everywhere: {}.", beside_drawn(drawn), needs);
}

bool names_both_bounds(const BestBias& best) {
  return !best.feasible && best.needs_more_than > 0.0 && best.needs_less_than > 0.0;
}

BiasAdvice bias_advice(const LightComparison& light, const raster::MapOptions& drawn) {
  const BestBias& best = light.best_bias;
  const std::string why =
      best.feasible ? std::string() : contradiction(best, light.bias_texel_world, drawn.bias);
  if (light.bias_kinds.empty()) return {constant_part(light), why};
  return {best_kind(light, drawn), joined_sentences({constant_alone(light), why})};
}

}  // namespace gnomon::compare
