#include "studies/diff/spread.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/result/threshold.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

bool is_soft(const Drawn& side) {
  return side.light.contains("shadow_samples");
}
bool draws_rays(const Drawn& side) {
  const Json& map = side.light.at("map");
  return map.contains("rays") && map["rays"].is_object();
}
/// Of one sample nothing tells how far off it is.
bool has_one_sample(const Drawn& side) {
  return side.light.value("shadow_samples", 0) == 1;
}
bool has_other_samples(const Drawn& a, const Drawn& b) {
  if (!is_soft(a) && !is_soft(b)) return false;
  return a.result.at("seed") != b.result.at("seed") ||
         a.light.value("shadow_samples", 0) != b.light.value("shadow_samples", 0);
}
double compared(const Drawn& side) {
  return double(std::max<std::uint64_t>(side.figures.pixels.compared, 1));
}

/// Their sum over all pixels that see a part of the light, over compared pixels.
double standard_errors(const Drawn& side) {
  if (!is_soft(side)) return 0.0;
  if (!side.light.contains("penumbra")) return unknown_spread;
  const Json& soft = side.light["penumbra"];
  return soft.at("standard_error_mean").get<double>() * soft.at("true_penumbra_pixels").get<double>() /
         compared(side);
}

/// The mean error moves by no more than the mean of what the truths are off by: |V6 - V0| by the inequality of the triangle.
/// Samples of neighbours go together, so that no root of their number may be taken.
double mean_by_samples(const Drawn& a, const Drawn& b) {
  return standard_errors(a) + standard_errors(b);
}

/// Pixels whose truth is within a standard error of one half fall to either side: twice the root of their number. With more
/// samples fewer of them are uncertain, and what is compared then may be wrong.
double wrong_by_samples(const Drawn& a, const Drawn& b) {
  const auto undecided = [](const Drawn& side) { return double(side.figures.pixels.uncertain_by_samples); };
  return (2.0 * std::sqrt(undecided(a) + undecided(b) + 1.0) + std::abs(undecided(a) - undecided(b))) /
         std::min(compared(a), compared(b));
}

double noise_step(const Drawn& side, std::initializer_list<const char*> keys) {
  double sum = 0.0;
  if (!draws_rays(side)) return sum;
  for (const Json& step : side.light.at("budget"))
    if (step.at("cause") == "noise")
      for (const char* key : keys) sum += step.at(key).get<double>();
  return sum;
}

/// A denoiser's window: pixels in it share their noise.
constexpr double pixels_together = 25.0;

/// Twice the standard error of the mean of the noise, over so many windows.
double mean_by_rays(const Drawn& a, const Drawn& b) {
  const auto variance = [](const Drawn& side) {
    const double noise = noise_step(side, {"absolute"});
    if (noise == 0.0) return 0.0;
    if (!side.light.contains("penumbra")) return unknown_spread;
    const double pixels = side.light["penumbra"].at("true_penumbra_pixels").get<double>();
    return noise * noise * pixels_together / std::max(pixels, pixels_together);
  };
  return 2.0 * std::sqrt(variance(a) + variance(b));
}

/// Twice the root of how many pixels the noise takes over one half.
double wrong_by_rays(const Drawn& a, const Drawn& b) {
  if (!draws_rays(a) && !draws_rays(b)) return 0.0;
  const double wrong =
      noise_step(a, {"false_shadow", "missed_shadow"}) + noise_step(b, {"false_shadow", "missed_shadow"});
  return 2.0 * std::sqrt(wrong + 1.0) / std::min(compared(a), compared(b));
}

/// Technique `rays` casts the same for the same settings and seed.
bool has_other_rays(const Drawn& a, const Drawn& b) {
  if (!draws_rays(a) && !draws_rays(b)) return false;
  if (a.result.at("seed") != b.result.at("seed") || !draws_rays(a) || !draws_rays(b)) return true;
  for (const char* key : {"rays_per_pixel", "ray_sampler", "denoiser", "history"})
    if (a.light.at("map").at("rays").value(key, Json()) != b.light.at("map").at("rays").value(key, Json()))
      return true;
  return false;
}

}  // namespace

bool has_other_gl(const Drawn& before, const Drawn& after) {
  return before.result.at("gl") != after.result.at("gl");
}

std::vector<std::string> chances(const Drawn& before, const Drawn& after) {
  std::vector<std::string> said;
  if (has_other_samples(before, after))
    said.emplace_back(
        "the light's samples are others (--seed, --samples): a change counts where it is more than their "
        "standard errors allow");
  if (has_other_rays(before, after))
    said.emplace_back(
        "the drawing's rays are others: a change counts where it is more than their noise allows");
  if (has_other_gl(before, after))
    said.emplace_back("another OpenGL drew (" + before.result.at("gl").at("renderer").get<std::string>() +
                      "; " + after.result.at("gl").at("renderer").get<std::string>() +
                      "): what that alone changes is not known");
  return said;
}

double spread(const compare::Figure& figure, const Drawn& before, const Drawn& after) {
  if (has_other_gl(before, after) || has_one_sample(before) || has_one_sample(after)) return unknown_spread;
  const bool samples = has_other_samples(before, after), rays = has_other_rays(before, after);
  if (!samples && !rays) return 0.0;
  if (&figure == compare::find_measure("wrong"))
    return (samples ? wrong_by_samples(before, after) : 0.0) + (rays ? wrong_by_rays(before, after) : 0.0);
  if (&figure == compare::find_measure("mean"))
    return (samples ? mean_by_samples(before, after) : 0.0) + (rays ? mean_by_rays(before, after) : 0.0);
  return unknown_spread;
}

}  // namespace gnomon::studies
