// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "app/options/pose_options.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "app/session.h"
#include "scene/files/validate.h"

namespace gnomon::app {

namespace {

Expected<Vec2> parse_orbit(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    return fail(ErrorKind::usage, fmt::format("not of the form AZIMUTH,ELEVATION (got {})", text));
  const Expected<double> azimuth = parse_number(text.substr(0, comma), azimuth_range);
  if (!azimuth) return fail(azimuth.error());
  const Expected<double> elevation = parse_number(text.substr(comma + 1), camera_elevation_range);
  if (!elevation) return fail(elevation.error());
  return Vec2{*azimuth, *elevation};
}

Expected<Vec3> parse_vector(const std::string& text) {
  Vec3 vector{0.0};
  std::size_t start = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? text.find(',', start) : text.size();
    if (comma == std::string::npos)
      return fail(ErrorKind::usage, fmt::format("not of the form X,Y,Z (got {})", text));
    const Expected<double> value = parse_number(text.substr(start, comma - start), coordinate_range);
    if (!value) return fail(value.error());
    vector[i] = *value;
    start = comma + 1;
  }
  return vector;
}

/// Below, squares of its length are lost.
constexpr double shortest_up = 1e-100;

Expected<Vec3> parse_up(const std::string& text) {
  auto up = parse_vector(text);
  if (up && !(glm::length(*up) > shortest_up))
    return fail(ErrorKind::usage,
                fmt::format("has no direction (got {}, allowed longer than {})", text, shortest_up));
  return up;
}

template <class Value, class Parse>
void add_pose_value(CLI::App& command, const std::string& name, const char* type, std::optional<Value>& field,
                    const std::string& text, const Parse& parse) {
  command
      .add_option_function<std::string>(
          name,
          [&field, name, parse](const std::string& value) {
            const Expected<Value> parsed = parse(value);
            if (!parsed) throw CLI::ValidationError(name, parsed.error().reason);
            field = *parsed;
          },
          text + "; default the scene's own]")
      ->type_name(type);
}

void add_pose_number(CLI::App& command, const std::string& name, const char* type,
                     std::optional<double>& field, const OptionRange& range, const std::string& what,
                     const char* unit) {
  add_pose_value(command, name, type, field, fmt::format("{} [{}, {}", what, unit, range_text(range)),
                 [range](const std::string& value) { return parse_number(value, range); });
}

/// The light that is to be turned.
Expected<std::uint32_t> chosen_light(const std::string& name, const Scene& scene) {
  if (name.empty() && scene.lights.size() > 1) {
    return fail(
        ErrorKind::usage,
        fmt::format("--light-azimuth, --light-elevation, --light-distance, --light-size: the scene has {} "
                    "lights; --light NAME says which one is meant",
                    scene.lights.size()));
  }
  const auto lights = choose_lights(scene, name);
  if (!lights) return fail(lights.error());
  return lights->front();
}

}  // namespace

void add_pose_options(CLI::App& command, PoseOptions& poses) {
  add_pose_value(
      command, "--camera-orbit", "AZIMUTH,ELEVATION", poses.camera_orbit,
      fmt::format(
          "where the eye stands, seen from the camera's target: azimuth 0 is +z and 90 is +x, elevation is "
          "above the horizon [degrees, {} and {}",
          range_text(azimuth_range), range_text(camera_elevation_range)),
      parse_orbit);
  add_pose_number(command, "--camera-distance", "D", poses.camera_distance, distance_range,
                  "distance of the eye from the camera's target", "world units");
  add_pose_value(
      command, "--camera-target", "X,Y,Z", poses.camera_target,
      fmt::format("what the camera looks at and turns about [world units, {}", range_text(coordinate_range)),
      parse_vector);
  add_pose_value(command, "--camera-up", "X,Y,Z", poses.camera_up,
                 fmt::format("the camera's up vector, about which --camera-orbit turns [{}, not 0,0,0",
                             range_text(coordinate_range)),
                 parse_up);
  add_pose_number(
      command, "--camera-height", "H", poses.camera_height, distance_range,
      "what the picture's height covers, through an orthographic camera, whatever the scene's own is",
      "world units");
  add_pose_number(
      command, "--light-azimuth", "DEG", poses.light_azimuth, azimuth_range,
      "where the light comes from: 0 is +z, 90 is +x; of the light named by --light, where there are several",
      "degrees");
  add_pose_number(
      command, "--light-elevation", "DEG", poses.light_elevation, light_elevation_range,
      "how high the light stands above the horizon; a lamp's angles are those seen from the scene's centre",
      "degrees");
  add_pose_number(command, "--light-distance", "D", poses.light_distance, distance_range,
                  "distance of a lamp from the scene's centre; a sun has none", "world units");
  add_pose_number(
      command, "--light-size", "S", poses.light_size, size_range,
      "how large the light is: of a sun the angular diameter of its disc, at most 90 degrees; of a "
      "lamp the radius "
      "of its sphere or disc, or half a rectangle's diagonal; 0 is a hard light",
      "degrees or world units");
}

Expected<ResolvedPoses> resolve_poses(const PoseOptions& poses, const std::string& light, const Scene& scene,
                                      const Vec3& centre) {
  ResolvedPoses resolved;
  if (poses.camera_orbit || poses.camera_distance || poses.camera_target || poses.camera_up ||
      poses.camera_height) {
    Camera camera = scene.camera;
    camera.up = poses.camera_up.value_or(camera.up);
    CameraPose pose = camera_pose(camera);
    if (poses.camera_orbit)
      pose.azimuth_degrees = poses.camera_orbit->x, pose.elevation_degrees = poses.camera_orbit->y;
    pose.distance = poses.camera_distance.value_or(pose.distance);
    pose.target = poses.camera_target;
    pose.up = poses.camera_up;
    pose.height = poses.camera_height;
    if (const auto defect = find_camera_defect(posed_camera(scene.camera, pose)))
      return fail(ErrorKind::usage, fmt::format("the camera's pose: {} {}", defect->field, defect->reason));
    resolved.camera = pose;
  }
  if (!poses.light_azimuth && !poses.light_elevation && !poses.light_distance && !poses.light_size)
    return resolved;
  const Expected<std::uint32_t> chosen = chosen_light(light, scene);
  if (!chosen) return fail(chosen.error());
  LightPose pose = light_pose(scene.lights[*chosen], centre);
  pose.azimuth_degrees = poses.light_azimuth.value_or(pose.azimuth_degrees);
  pose.elevation_degrees = poses.light_elevation.value_or(pose.elevation_degrees);
  if (poses.light_distance && scene.lights[*chosen].type == LightType::directional)
    return fail(ErrorKind::usage,
                fmt::format("--light-distance: {} is a directional light, which has no place",
                            scene.lights[*chosen].name));
  if (poses.light_size && scene.lights[*chosen].type == LightType::directional &&
      *poses.light_size > most_sun_degrees)
    return fail(ErrorKind::usage,
                fmt::format("--light-size: too large for a sun (got {}, allowed 0 to {} degrees)",
                            *poses.light_size, most_sun_degrees));
  pose.distance = poses.light_distance;
  pose.size = poses.light_size;
  resolved.light_pose = pose;
  resolved.light = *chosen;
  return resolved;
}

Expected<void> apply_poses(const PoseOptions& poses, const std::string& light, Scene& scene,
                           const World& world) {
  const Expected<ResolvedPoses> resolved = resolve_poses(poses, light, scene, world.middle());
  if (!resolved) return fail(resolved.error());
  if (resolved->camera) scene.camera = posed_camera(scene.camera, *resolved->camera);
  if (!resolved->light_pose) return {};
  Light& turned = scene.lights[resolved->light];
  turned = posed_light(turned, world.middle(), *resolved->light_pose);
  return {};
}

Expected<void> apply_poses(const PoseOptions& poses, const std::string& light, LoadedScene& loaded) {
  const auto applied = apply_poses(poses, light, *loaded.scene, *loaded.world);
  if (applied) loaded.plan = plan_effects(*loaded.scene);
  return applied;
}

}  // namespace gnomon::app
