#include "app/outputs/picture_samples.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/options/options.h"
#include "app/options/values.h"

namespace gnomon::app {

namespace {

void add_count(CLI::App& command, const char* name, std::optional<int>& count, int least,
               const std::string& what, const std::string& fallback) {
  add_checked(command, name, "N",
              fmt::format("{} [{} to {}; default {}]", what, least, max_samples, fallback),
              [&count, least](const std::string& text) -> Expected<void> {
                const Expected<std::int64_t> value = parse_integer(text, least, max_samples);
                if (!value) return fail(value.error());
                count = static_cast<int>(*value);
                return {};
              });
}

}  // namespace

void add_picture_samples(CLI::App& command, PictureSamples& samples) {
  add_count(
      command, "--aa", samples.per_pixel, 1,
      "antialiasing: stratified, seeded samples per pixel, whose mean is the pixel; they share the other "
      "samples among them",
      "the camera's samples_per_pixel, 1: the pixel's centre");
  add_count(command, "--glossy-samples", samples.glossy, 1, "rays from each point of a rough mirror or glass",
            "the scene's glossy.samples, 16");
  add_count(command, "--indirect-samples", samples.indirect, 0,
            "rays from each point that gather light reflected once; 0 leaves it out",
            "the scene's indirect.samples, 0");
}

void apply_picture_samples(const PictureSamples& samples, Scene& scene) {
  if (samples.per_pixel) scene.camera.samples_per_pixel = *samples.per_pixel;
  if (samples.glossy) scene.glossy_samples = *samples.glossy;
  if (samples.indirect) scene.indirect_samples = *samples.indirect;
}

std::string many_rays_note(const Scene& scene, const EffectPlan& plan, double min_contribution,
                           const ImageSize& size) {
  constexpr double many = 1e11;  // an hour or more on any machine
  if (!plan.simulates(Effect::refraction)) return {};
  const double split = std::pow(2.0, scene.max_depth), kept = 1.0 / min_contribution;  // infinite at 0
  const double rays =
      std::min(split, kept) * static_cast<double>(size.pixels()) * scene.camera.samples_per_pixel;
  if (rays < many) return {};
  return fmt::format(
      "Glass may take up to {:.1g} rays: it splits a ray in two at each surface, to the scene's max_depth of "
      "{}; a "
      "larger --min-contribution than {} ends them sooner.",
      rays, scene.max_depth, min_contribution);
}

}  // namespace gnomon::app
