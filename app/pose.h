// Where the camera stands and where a light comes from, as angles: what the viewer turns and what scripts
// set. Degrees. About y, azimuth 0 is +z and 90 is +x, as in scene files; elevation is the height above the
// horizon. A camera turns about its own up vector. A pose fixes the result bit for bit: no drift, whatever
// the way to it was.
#pragma once

#include <optional>

#include "scene/light.h"
#include "scene/world.h"

namespace gnomon::app {

/// The eye as seen from the camera's target; lengths in world units.
struct CameraPose {
  double azimuth_degrees = 0.0, elevation_degrees = 0.0, distance = 1.0;
  std::optional<Vec3> target{};  ///< none: the camera's own
  std::optional<Vec3> up{};      ///< what azimuth and elevation are counted about; none: the camera's own
  std::optional<double>
      height{};  ///< of an orthographic picture, which it makes of any; none: the camera's own
  bool operator==(const CameraPose&) const = default;
};

/// Where the light comes from: a sun's place in the sky, a lamp's as seen from the centre of the scene.
struct LightPose {
  double azimuth_degrees = 0.0, elevation_degrees = 0.0;
  std::optional<double> distance{};  ///< of a lamp from the centre, world units; none: its own
  std::optional<double> size{};      ///< as light_size() has it; none: its own
  bool operator==(const LightPose&) const = default;
};

/// Short of the pole, where the camera's up vector would lie along its view.
inline constexpr double max_camera_elevation_degrees = 89.0;
inline constexpr double max_light_elevation_degrees = 90.0;

CameraPose camera_pose(const Camera& camera);
/// `given` with its eye and, where the pose has them, its target, its up vector and its height changed; its angle stays.
Camera posed_camera(const Camera& given, const CameraPose& pose);

LightPose light_pose(const Light& light, const Vec3& centre);
inline constexpr double most_sun_degrees = 90.0;
/// The light in another size, as light_size() has it: shapes keep theirs, and a point becomes a sphere.
Light resized_light(const Light& light, double size);
/// `given` turned about `centre` at its own distance or the pose's and in the pose's size; a spot keeps its aim relative
/// to the line to the centre.
Light posed_light(const Light& given, const Vec3& centre, const LightPose& pose);

inline double degrees(double radians) {
  return radians * 180.0 / pi;
}
/// Returns the angle that is the same within (-180, 180].
double wrapped_degrees(double degrees);

}  // namespace gnomon::app
