// --camera-orbit, --camera-distance, --camera-target, --camera-up, --camera-height, --light-azimuth, --light-elevation,
// --light-distance, --light-size: another camera and another light than the scene's own, for every command that draws.
#pragma once

#include <optional>
#include <string>

#include "app/options/values.h"
#include "app/pose.h"
#include "scene/base/expected.h"
#include "scene/world.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct LoadedScene;

// What the options take, and the lab's script with them: degrees, and world units.
inline constexpr OptionRange azimuth_range{-360.0, 360.0};
inline constexpr OptionRange camera_elevation_range{-max_camera_elevation_degrees,
                                                    max_camera_elevation_degrees};
inline constexpr OptionRange light_elevation_range{-max_light_elevation_degrees, max_light_elevation_degrees};
inline constexpr OptionRange distance_range{0.0, 1e12, true};
inline constexpr OptionRange coordinate_range{-1e12, 1e12};
inline constexpr OptionRange size_range{0.0, 1e12};

struct PoseOptions {
  std::optional<Vec2> camera_orbit;                      ///< azimuth, elevation: degrees
  std::optional<double> camera_distance;                 ///< world units
  std::optional<Vec3> camera_target;                     ///< world
  std::optional<Vec3> camera_up;                         ///< not zero
  std::optional<double> camera_height;                   ///< world units
  std::optional<double> light_azimuth, light_elevation;  ///< degrees
  std::optional<double> light_distance;                  ///< world units, of a lamp
  std::optional<double> light_size;                      ///< light_size()
};

void add_pose_options(CLI::App& command, PoseOptions& poses);

/// The poses in full, each angle that is not given being the scene's own.
struct ResolvedPoses {
  std::optional<CameraPose> camera;
  std::optional<LightPose> light_pose;
  std::uint32_t light = 0;  ///< whose pose it is
};

/// The light is the one of that name or, without a name, the only one there is. Errors are ErrorKind::usage, also
/// where the camera's pose is one that nothing can be seen with. `scene`: whose camera and lights are posed; `centre`:
/// what a lamp turns about, World::middle().
Expected<ResolvedPoses> resolve_poses(const PoseOptions& poses, const std::string& light, const Scene& scene,
                                      const Vec3& centre);

/// Moves the scene's camera and turns its light.
Expected<void> apply_poses(const PoseOptions& poses, const std::string& light, Scene& scene,
                           const World& world);
/// Changes a scene that is loaded, and plans its effects again: a light may have another size.
Expected<void> apply_poses(const PoseOptions& poses, const std::string& light, LoadedScene& loaded);

}  // namespace gnomon::app
