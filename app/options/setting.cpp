#include "app/options/setting.h"

#include <CLI/CLI.hpp>

#include "app/options/options.h"
#include "app/session.h"

namespace gnomon::app {

void add_setting_options(CLI::App& command, SettingOptions& setting) {
  compare::CompareOptions& options = setting.options;
  add_size(command, options.raster.size);
  add_map_options(command, options.raster.map);
  add_light(command, setting.light, "compare this light only");
  add_pose_options(command, setting.poses);
  add_tracer_options(command, options.accel, options.precision);
  add_min_contribution(command, options.raytrace.min_contribution);
  add_samples(command, options.raytrace.shadow_samples);
}

Expected<compare::Setting> resolve_setting(const SettingOptions& from, const Scene& given,
                                           const World& world) {
  compare::Setting setting;
  setting.raster = from.options.raster;
  setting.raytrace = from.options.raytrace;
  setting.raytrace.size = setting.raster.size;
  setting.accel = from.options.accel;
  setting.precision = from.options.precision;
  const auto compared = choose_lights(given, from.light);
  if (!compared) return fail(compared.error());
  setting.compared = *compared;
  // Poses need the scene's camera and lights alone.
  Scene posed;
  posed.camera = given.camera;
  posed.lights = given.lights;
  const auto applied = apply_poses(from.poses, from.light, posed, world);
  if (!applied) return fail(applied.error());
  setting.camera = posed.camera;
  setting.lights = std::move(posed.lights);
  return setting;
}

}  // namespace gnomon::app
