#include "compare/advice/candidates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "compare/advice/rule.h"
#include "compare/bias/bias_advice.h"
#include "compare/bias/bias_curve.h"
#include "compare/bias/derived_bias.h"
#include "compare/result/figures.h"
#include "compare/result/output_parts.h"
#include "raster/settings.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

using raster::MapOptions;
using raster::Technique;

constexpr int least_size = 16;
constexpr int most_size =
    8192;  // a larger map takes longer to draw in software than all the rest of a comparison
constexpr double least_part = 0.2;  // of the error, for which another setting is drawn
/// A sampling error halves with a map of twice the side: then a fifth of the whole goes.
constexpr double least_sampled_part = 0.4;

/// The part of a light's error that has one of these labels.
double part_of(const LightComparison& light, std::initializer_list<Label> labels) {
  double part = 0.0;
  for (const Label label : labels) part += light.class_errors[static_cast<std::size_t>(label) - 1];
  return light.error.mean_absolute > 0.0 ? part / light.error.mean_absolute : 0.0;
}

/// Whether it would be advised if this part of the error went.
bool could_be_worth(double part, const Comparison& c, const LightComparison& light) {
  const Left now = left_by(light, *c.measure);
  const double stays = 1.0 - part;
  return is_worth_advising({stays * now.wrong_fraction, stays * now.mean_absolute, stays * now.measured}, now,
                           light.pixels.compared);
}

/// The bias that leaves no acne: where each texel of a filter is compared with the receiver itself, the one that follows from
/// the filter's reach, else the default.
raster::Bias bias_without_acne(const Comparison& c, const LightComparison& light) {
  const MapOptions map = asked_options(c);
  raster::Bias bias = raster::default_bias(map);
  if (raster::effective_options(map).bias.receiver_plane) return bias;
  if (const auto derived = derive_bias(map, drawn_record(c, light), *c.world)) {
    bias = {derived->constant_texels, raster::BiasUnit::texel, derived->slope};
    bias.constant = rounded_to_three(bias.constant);
  }
  return bias;
}

/// Moments let light through within shadows: more of what is taken as bleeding, or a steeper exponent.
std::optional<MapOptions> with_less_bleeding(MapOptions map) {
  constexpr double strong_reduction = 0.5;
  raster::FilterOptions& filter = map.filter;
  const raster::FilterOptions usual;
  const raster::FilterOptions before = filter;
  if (raster::reads_setting(map, "esm-exponent"))
    filter.esm_exponent = std::max(filter.esm_exponent, usual.esm_exponent);
  if (raster::reads_setting(map, "evsm-exponent") &&
      filter.evsm_positive_exponent < usual.evsm_positive_exponent)
    filter.evsm_positive_exponent = usual.evsm_positive_exponent;
  else if (raster::reads_setting(map, "bleeding-reduction"))
    filter.light_bleeding_reduction = std::max(filter.light_bleeding_reduction, strong_reduction);
  if (filter == before) return std::nullopt;
  return map;
}

/// Of a technique whose gaps tell nothing.
std::optional<MapOptions> with_another_bias(const Comparison& c, const LightComparison& light, bool acne) {
  MapOptions map = asked_options(c);
  if (!acne && raster::uses_moments(map.technique)) return with_less_bleeding(map);
  map.bias = acne ? bias_without_acne(c, light) : raster::default_bias(map);
  if (map == asked_options(c) || !raster::check_map_options(map)) return std::nullopt;
  return map;
}

std::optional<Candidate> of_bias(const Comparison& c, const LightComparison& light, double& part) {
  if (!draws_bias(c)) return std::nullopt;
  if (biases_follow_from_gaps(c.raster)) {
    if (gaps_tell(light, *c.measure)) return std::nullopt;
    Candidate candidate{asked_options(c)};
    const LikelyBias likely = likeliest_bias(light, candidate.map);
    candidate.map.bias = likely.bias;
    part = light.error.wrong_fraction > 0.0 ? 1.0 - likely.wrong_fraction / light.error.wrong_fraction : 0.0;
    if (candidate.map == asked_options(c) || !(part > 0.0)) return std::nullopt;
    return candidate;
  }
  const double acne = part_of(light, {Label::acne, Label::stored_depth});
  const double leak = part_of(light, {Label::light_leak, Label::peter_panning});
  part = std::max(acne, leak);
  if (part < least_part || !could_be_worth(part, c, light)) return std::nullopt;
  const auto map = with_another_bias(c, light, acne >= leak);
  if (!map) return std::nullopt;
  return Candidate{*map};
}

/// Whether a map of that size may leave a fifth less: by the estimate, and where there is none by the part of the error that
/// texels have.
bool may_gain(int size, double sampled, const LightComparison& light) {
  constexpr double left = 0.8, sure = 2.0;
  for (const OtherMapSize& other : light.other_sizes)
    if (other.size == size)
      return other.mean_absolute + sure * other.standard_error < left * light.error.mean_absolute;
  return sampled >= least_sampled_part;
}

std::optional<Candidate> of_larger_map(const Comparison& c, const LightComparison& light, double& part) {
  Candidate candidate{asked_options(c)};
  candidate.map.size *= 2;
  if (!compares_depths(c) || candidate.map.size > most_size) return std::nullopt;
  part = part_of(light, {Label::aliasing, Label::missed_feature, Label::false_feature, Label::blur});
  if (candidate.map.bias.unit != raster::BiasUnit::world)
    part += part_of(light, {Label::peter_panning, Label::light_leak});
  if (part < least_part || !may_gain(candidate.map.size, part, light)) return std::nullopt;
  const double texels = 0.5 * std::max(part, least_sampled_part);  // halves with a texel's side
  if (!could_be_worth(texels, c, light)) return std::nullopt;
  return candidate;
}

/// Whether another technique may be asked for behind what was typed. A technique that was typed takes its own options with it.
bool can_be_appended(const MapOptions& map, const MapOptions& drawn) {
  const MapOptions usual;
  const auto settings = raster::map_settings();
  return drawn.technique != usual.technique ||
         std::all_of(settings.begin(), settings.end(), [&](const raster::MapSetting& setting) {
           return raster::reads_setting(map, setting.name) ||
                  raster::setting_text(setting, drawn) == raster::setting_text(setting, usual);
         });
}

std::vector<Candidate> soft_techniques(const Comparison& c) {
  std::vector<Candidate> out;
  const MapOptions drawn = asked_options(c);
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    const auto has_map = [&](const LightComparison& one) { return traits.lights.has(light_of(c, one).type); };
    if (!traits.soft || !std::all_of(c.lights.begin(), c.lights.end(), has_map)) continue;
    Candidate candidate{drawn, true};
    candidate.map.technique = traits.technique;
    if (drawn.bias == raster::default_bias(drawn)) candidate.map.bias = raster::default_bias(candidate.map);
    if (raster::check_map_options(candidate.map) && can_be_appended(candidate.map, drawn))
      out.push_back(candidate);
  }
  return out;
}

/// The technique's own settings. What is no matter of the technique stays, and a bias of which gaps tell all.
std::optional<Candidate> of_defaults(const Comparison& c, const LightComparison& light) {
  const MapOptions drawn = asked_options(c);
  MapOptions usual;
  usual.technique = drawn.technique, usual.filter.kernel = drawn.filter.kernel;
  usual.size = drawn.size, usual.window = drawn.window;
  usual.rays.count = drawn.rays.count,
  usual.rays.history = drawn.rays.history;  // what they cost is for the user to say
  usual.bias = biases_follow_from_gaps(c.raster) && gaps_tell(light, *c.measure)
                   ? drawn.bias
                   : raster::default_bias(usual);
  if (changed_arguments(usual, drawn).empty() || !could_be_worth(1.0, c, light)) return std::nullopt;
  return Candidate{usual};
}

/// Where noise has the larger part twice the rays; else a denoiser that blurs less.
std::optional<Candidate> of_rays(const Comparison& c, const LightComparison& light) {
  Candidate candidate{asked_options(c)};
  raster::RayOptions& rays = candidate.map.rays;
  if (!raster::samples_rays(candidate.map.technique) || !could_be_worth(1.0, c, light)) return std::nullopt;
  const double noise = part_of(light, {Label::noise}), blur = part_of(light, {Label::blur, Label::remap});
  if (noise >= blur && rays.count != raster::RayCount::sixteen)
    rays.count = static_cast<raster::RayCount>(static_cast<int>(rays.count) + 1);
  else if (noise < blur && rays.denoiser != raster::Denoiser::none)
    rays.denoiser =
        rays.denoiser == raster::Denoiser::penumbra ? raster::Denoiser::none : raster::Denoiser::penumbra;
  else
    return std::nullopt;
  return candidate;
}

}  // namespace

std::vector<Candidate> candidates(const Comparison& c, const LightComparison& light) {
  if (!(light.error.mean_absolute > 0.0) || !c.raster.has_known_map()) return {};
  if (lacks_light_size(c.raster, light)) return soft_techniques(c);
  if (lacks_window(c, light)) return {};
  double mended = 0.0, sampled = 0.0;
  const auto bias = of_bias(c, light, mended), larger = of_larger_map(c, light, sampled);
  std::vector<Candidate> out;
  const auto usual = of_defaults(c, light);
  if (usual) out.push_back(*usual);
  if (const auto rays = of_rays(c, light); rays && !(usual && rays->map == usual->map)) out.push_back(*rays);
  if (larger && sampled > mended) out.push_back(*larger);
  if (bias && !(usual && bias->map == usual->map)) out.push_back(*bias);
  if (larger && !(sampled > mended)) out.push_back(*larger);
  return out;
}

MapOptions asked_options(const Comparison& c) {
  MapOptions map = c.raster.options.map;
  if (raster::reads_setting(map, "filter-plane") && map.filter.receiver_plane && !map.bias.adaptive)
    map.bias.receiver_plane = false;
  return map;
}

// Most of the error is that a light with size was taken for its centre. No filter makes up for most of that, and no other
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

bool lacks_window(const Comparison& c, const LightComparison& light) {
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
  return !c.raster.options.map.window.empty() && 2 * outside > light.error.wrong;
}

// An edge of texels w pixels wide lies anywhere within w: it is off by w / sqrt(12) in the root mean square.
int halvings(int size, double pixels) {
  const double widest = 0.5 * std::sqrt(12.0);
  int times = 0;
  while (pixels > 0.0 && (size >> (times + 1)) >= least_size && std::ldexp(pixels, times + 1) <= widest)
    ++times;
  return times;
}

std::string changed_arguments(const MapOptions& map, const MapOptions& drawn) {
  std::vector<std::pair<std::string, std::string>> changed;
  for (const raster::MapSetting& setting : raster::map_settings()) {
    if (setting.group == raster::SettingGroup::bias || !raster::reads_setting(map, setting.name)) continue;
    std::string value = raster::setting_text(setting, map);
    if (value != raster::setting_text(setting, drawn)) changed.emplace_back(setting.name, std::move(value));
  }
  std::string text = fmt::format("{}", fmt::join(raster::words_of(changed), " "));
  if (map.bias == drawn.bias) return text;
  return text + (text.empty() ? "" : " ") + raster::bias_arguments(map.bias, drawn);
}

}  // namespace gnomon::compare
