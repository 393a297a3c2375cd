#include "app/options/effect_options.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "raster/technique_traits.h"
#include "scene/light.h"
#include "scene/light_map/light_view.h"

namespace gnomon::app {
namespace {

bool holds(std::span<const std::string> given, std::string_view option) {
  return std::find(given.begin(), given.end(), option) != given.end();
}

std::string without_effect(std::string_view option, std::string_view reason) {
  return fmt::format("--{} has no effect: {}", option, reason);
}

}  // namespace

std::vector<std::string> given_options(const CLI::App& command) {
  std::vector<std::string> given;
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && !option->get_lnames().empty()) given.push_back(option->get_lnames().front());
  return given;
}

std::vector<std::string> options_without_effect(std::span<const std::string> given, const EffectPlan& plan) {
  std::vector<std::string> notes;
  const auto needs = [&](std::string_view option, Effect effect) {
    if (holds(given, option) && !plan.simulates(effect))
      notes.push_back(without_effect(option, plan[effect].reason));
  };
  needs("samples", Effect::soft_shadow);
  needs("glossy-samples", Effect::glossy);
  needs("min-contribution", Effect::reflection);  // whose reason names transmission too
  return notes;
}

std::vector<std::string> options_without_effect(std::span<const std::string> given,
                                                const raster::MapOptions& map, const Scene& scene,
                                                std::span<const std::uint32_t> lights) {
  std::vector<std::string> notes;
  const auto all_idle = [&](std::initializer_list<const char*> options, std::string_view reason) {
    for (const char* option : options)
      if (holds(given, option)) notes.push_back(without_effect(option, reason));
  };
  const auto any = [&](const auto& holds_for) {
    return std::any_of(lights.begin(), lights.end(),
                       [&](std::uint32_t light) { return holds_for(scene.lights[light]); });
  };
  if (raster::traits_of(map.technique).filter == raster::EdgeFilter::penumbra && !any(has_size))
    all_idle({"filter-samples", "blocker-samples", "search-radius"},
             "pcss is the hard test for lights without a size");
  if (raster::samples_rays(map.technique) && !any(has_size))
    all_idle({"rays", "ray-sampler", "denoiser", "history"},
             "no light has a size, and one ray to its centre is exact");
  if (map.snap && !any([](const Light& light) { return light.type == LightType::directional; }))
    all_idle({"snap"}, "no light is directional");
  if (raster::has_cascades(map.technique) && map.cascades.count == 1)
    all_idle({"cascade-lambda", "cascade-blend"}, "there is one cascade");
  return notes;
}

std::vector<std::string> page_options_without_effect(std::span<const std::string> given) {
  if (!holds(given, "report-max-mb")) return {};
  return {without_effect("report-max-mb", "no page is written")};
}

std::vector<std::string> heatmap_options_without_effect(std::span<const std::string> given) {
  std::vector<std::string> notes;
  for (const char* option : {"aa", "exposure", "glossy-samples", "indirect-samples", "light", "max-lights",
                             "min-contribution", "samples", "seed"})
    if (holds(given, option))
      notes.push_back(
          without_effect(option, "a heat map shows the work of one ray through each pixel's centre"));
  return notes;
}

namespace {

/// The camera a hundredth of its distance to the right.
Camera moved_aside(Camera camera) {
  const Vec3 ahead = camera.target - camera.eye;
  const Vec3 right = glm::cross(ahead, camera.up);
  const double length = glm::length(right);
  const Vec3 step = length > 0.0 ? right * (0.01 * glm::length(ahead) / length) : Vec3(0.0);
  camera.eye += step, camera.target += step;
  return camera;
}

bool swims(const World& world, const Light& light, const raster::MapOptions& map, double aspect) {
  if (light.type != LightType::directional) return false;     // its map stays with the light
  if (!raster::compares_depths(map.technique)) return false;  // whatever the map, the answer is the same
  if (map.snap) return false;                                 // it stands still between steps
  switch (raster::traits_of(map.technique).texels) {
    case raster::TexelShape::cascades:
      return !map.cascades.snap || map.cascades.fit_samples;
    case raster::TexelShape::warped:
      return true;
    case raster::TexelShape::of_light:
      break;
  }
  const Camera& camera = world.scene->camera;
  return window_moves(world, light, {camera, moved_aside(camera)}, aspect, map.size, map.window);
}

/// What moves by whole texels in its place.
const char* way_out(const raster::MapOptions& map) {
  switch (raster::traits_of(map.technique).texels) {
    case raster::TexelShape::cascades:
      return "without --no-snap and --cascade-fit it moves by whole texels";
    case raster::TexelShape::warped:
      return "--technique csm moves by whole texels";
    case raster::TexelShape::of_light:
      break;
  }
  return "--technique csm moves by whole texels, and so does this map with --snap";
}

}  // namespace

std::string swim_note(const World& world, const raster::MapOptions& map, ImageSize size,
                      std::span<const std::uint32_t> lights) {
  std::vector<std::string> names;
  for (const std::uint32_t index : lights) {
    const Light& light = world.scene->lights[index];
    if (swims(world, light, map, double(size.width) / size.height)) names.push_back(light.name);
  }
  if (names.empty()) return {};
  return fmt::format(
      "The map of {} follows the camera by parts of a texel ({}), so shadow edges swim when the camera "
      "moves: "
      "{}.",
      fmt::join(names, ", "), raster::technique_name(map.technique), way_out(map));
}

}  // namespace gnomon::app
