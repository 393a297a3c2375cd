#include "lab/view/state/status.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/lesson_scene.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/shadow_cost.h"
#include "raster/settings.h"

namespace gnomon::lab {

namespace {

std::string bias_words(const raster::MapOptions& map, const Readings& readings) {
  const raster::Bias& bias = map.bias;
  const double texels = bias.unit == raster::BiasUnit::texel ? bias.constant
                        : readings.texel_world > 0.0         ? readings.bias_world / readings.texel_world
                                                             : 0.0;
  return fmt::format("bias {:.4g} = {}", readings.bias_world, compare::texels_text(texels, 4)) +
         compare::beside_constant(map);
}

std::string compared_words(const std::optional<Readings::Compared>& compared) {
  if (!compared) return "comparing…";
  std::string text = "wrong " + compare::percent(compared->wrong_fraction) + ", mean error " +
                     compare::percent(compared->mean_absolute);
  if (!compared->current) return text + " (before)";
  return compared->preview ? text + " (preview)" : text;
}

using Words = std::vector<std::string>;

/// A value that begins with a dash is joined to its option, so as not to look like one.
void add_if(Words& words, bool wanted, std::string_view key, const std::string& value) {
  if (!wanted) return;
  if (value.starts_with('-')) {
    words.push_back(fmt::format("{}={}", key, value));
  } else {
    words.emplace_back(key);
    words.push_back(value);
  }
}

void add_poses(Words& words, const Setup& setup) {
  if (setup.camera) {
    const app::CameraPose& pose = *setup.camera;
    add_if(words, true, "--camera-orbit",
           fmt::format("{},{}", number_text(pose.azimuth_degrees), number_text(pose.elevation_degrees)));
    add_if(words, true, "--camera-distance", number_text(pose.distance));
    const auto vector = [&](std::string_view key, const std::optional<Vec3>& v) {
      if (v)
        add_if(words, true, key,
               fmt::format("{},{},{}", number_text(v->x), number_text(v->y), number_text(v->z)));
    };
    vector("--camera-target", pose.target);
    vector("--camera-up", pose.up);
    if (pose.height) add_if(words, true, "--camera-height", number_text(*pose.height));
  }
  if (const std::optional<app::LightPose>& pose = setup.lights[setup.light]) {
    add_if(words, true, "--light-azimuth", number_text(pose->azimuth_degrees));
    add_if(words, true, "--light-elevation", number_text(pose->elevation_degrees));
    if (pose->distance) add_if(words, true, "--light-distance", number_text(*pose->distance));
    if (pose->size) add_if(words, true, "--light-size", number_text(*pose->size));
  }
}

}  // namespace

std::vector<std::string> other_turned_lights(const ViewState& state) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < state.given.lights.size(); ++i) {
    if (i != state.setup.light && state.setup.lights[i]) names.push_back(state.given.lights[i].name);
  }
  return names;
}

std::string status_line(const ViewState& state, const Readings& readings, const std::string& scene) {
  std::string text = fmt::format("{} | {}", scene, picture_name(state.picture));
  if (state.given.lights.size() > 1) text += fmt::format(" | {}", state.light_name());
  text += fmt::format(" | {} {}² | {}", raster::technique_name(state.setup.map.technique),
                      state.setup.map.size, bias_words(state.setup.map, readings));
  if (state.setup.map_camera) text += " | map's camera frozen";
  return text + fmt::format(" | live {} | {}", compare::milliseconds(readings.raster_ms),
                            compared_words(readings.compared));
}

std::vector<std::string> backend_words(raster::Backend backend) {
  Words words;
  std::istringstream text(app::backend_argument(backend));
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> pose_words(const ViewState& state) {
  Words words;
  add_if(words, state.given.lights.size() > 1, "--light", std::string(state.light_name()));
  add_poses(words, state.setup);
  return words;
}

namespace {

/// What compare and tune take alike: of the view's settings all but the picture's size and the map.
void add_truth(Words& words, const ViewState& state, const LabOptions& options) {
  const compare::CompareOptions plain;
  for (std::string& word : pose_words(state)) words.push_back(std::move(word));
  add_if(words, options.compare.accel != plain.accel, "--accel",
         std::string(raytrace::accel_name(options.compare.accel)));
  add_if(words, state.setup.precision != plain.precision, "--precision",
         std::string(raytrace::precision_name(state.setup.precision)));
  add_if(words, options.compare.raytrace.min_contribution != plain.raytrace.min_contribution,
         "--min-contribution", number_text(options.compare.raytrace.min_contribution));
  add_if(words, options.max_lights != app::usual_max_lights, "--max-lights",
         std::to_string(options.max_lights));
  for (std::string& word : backend_words(options.backend)) words.push_back(std::move(word));
  add_if(words, !options.shader_folder.empty(), "--shader-dir", options.shader_folder);
}

std::string size_text(const ImageSize& size) {
  return fmt::format("{}x{}", size.width, size.height);
}

/// Returns a size of the same shape that has at most `most` pixels.
ImageSize with_at_most(const ImageSize& size, double most) {
  const double scale = std::min(1.0, std::sqrt(most / static_cast<double>(size.pixels())));
  const auto scaled = [&](int n) { return std::max(1, static_cast<int>(std::lround(scale * n))); };
  return {scaled(size.width), scaled(size.height)};
}

}  // namespace

std::vector<std::string> setting_words(const ViewState& state, const LabOptions& options,
                                       const std::string& scene) {
  Words words;
  add_if(words, !options.camera.empty(), "--camera", options.camera);
  add_if(words, options.tessellate > 0, "--tessellate", std::to_string(options.tessellate));
  add_if(words, true, "--size", size_text(state.setup.size));
  const Words of_map = raster::words_of(app::settled_values(scene, raster::map_values(state.setup.map)));
  words.insert(words.end(), of_map.begin(), of_map.end());
  add_truth(words, state, options);
  if (options.exposure)
    add_if(words, true, "--exposure", *options.exposure ? number_text(**options.exposure) : "auto");
  return words;
}

std::vector<std::string> tuning_words(const ViewState& state, const LabOptions& options) {
  Words words;
  add_if(words, !options.camera.empty(), "--camera", options.camera);
  add_if(words, true, "--size", size_text(with_at_most(state.setup.size, tuned_pixels)));
  add_truth(words, state, options);
  return words;
}

std::string compare_command(const ViewState& state, const LabOptions& options,
                            const app::SceneArgument& scene) {
  std::string text = "gnomon compare " + scene.words();
  for (const std::string& word : setting_words(state, options, scene.name))
    text += fmt::format(" {}", shell_quoted(word));
  return text;
}

Readings readings_of(const Snapshot& shown, const ViewState& state) {
  Readings out{shown.live.bias_world, shown.live.texel_world, shown.live.raster_ms, {}};
  const ComparisonOutcome* outcome = shown.outcome.get();
  if (outcome == nullptr) return out;
  const compare::LightComparison& light = outcome->comparison.lights.front();
  out.compared = Readings::Compared{outcome->revision == state.revision, outcome->preview,
                                    light.error.wrong_fraction, light.error.mean_absolute};
  return out;
}

namespace {

std::string clock_words(const ShadowTimes& times, const std::string& renderer) {
  if (times.step_ms == 0.0)
    return fmt::format("{} runs, by the processor: {} is no GPU.", times.map.runs.size(), renderer);
  const std::string runs = fmt::format("{} runs of {} drawings, in steps of {}", times.map.runs.size(),
                                       times.drawings, compare::milliseconds(times.step_ms));
  if (times.by_device)
    return fmt::format("Map and lookups by the clock of {}: {}. Rays on the processor.", renderer, runs);
  return fmt::format(
      "Map and lookups are a guess: no clock of {} is to be read here, and the processor's counts the wait "
      "for the driver too; {}. Rays on the processor.",
      renderer, runs);
}

compare::ShadowParts parts_of(const ShadowTimes& times, const compare::Comparison& comparison) {
  const Times& map = times.map;
  return {.map = {map, map.least(), map.median(), map.most(), true},
          .lookups = times.lookups(),
          .rays = with_spread(comparison.raytraced.lights.front().exact_times()),
          .tree = with_spread(comparison.raytraced.structure),
          .by = compare::shadow_side(comparison.raster.options.map.technique)};
}

}  // namespace

ShadowTimeWords shadow_time_words(const Snapshot& shown, const ViewState& state) {
  if (!shown.outcome) return ShadowTimeWords();
  ShadowTimeWords words;
  words.by = "They are timed while nothing else is to be done.";
  std::optional<compare::ShadowCosts> costs;
  std::string_view by = "map";
  if (const auto times = shown.shadow_times; times && times->revision == state.revision) {
    const compare::ShadowParts parts = parts_of(*times, shown.outcome->comparison);
    costs = compare::shadow_costs(parts), by = parts.by;
    words.of_device = times->by_device, words.by = clock_words(*times, shown.renderer);
  }
  for (const compare::ShadowSituation& one : compare::shadow_situations())
    words.rows.push_back(
        {std::string(one.words), costs ? compare::sides_text(*costs.*one.sides, by) : "not timed yet"});
  return words;
}

}  // namespace gnomon::lab
