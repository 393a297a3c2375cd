#include "compare/path.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::compare {
namespace {

constexpr double turn_per_second = 10.0 * pi / 180.0;
constexpr double walk_per_second = 0.1;
constexpr double day = 170.0 * pi / 180.0;  // of the sun's half circle

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  return Mat3(glm::rotate(Mat4(1.0), angle, axis)) * v;
}

Camera moved_camera(const ShimmerPath& path, const Camera& first, double seconds) {
  Camera camera = first;
  const Vec3 up = glm::normalize(first.up), ahead = first.target - first.eye;
  const double angle = path.speed * turn_per_second * seconds;
  switch (path.camera) {
    case CameraPath::still:
    case CameraPath::drift:
      break;
    case CameraPath::orbit:
      camera.eye = first.target - turned(ahead, up, angle);
      break;
    case CameraPath::turn:
      camera.target = first.eye + turned(ahead, up, angle);
      break;
    case CameraPath::walk: {
      const Vec3 level = ahead - glm::dot(ahead, up) * up;
      const Vec3 along = glm::length(level) > 0.0 ? glm::normalize(level) : glm::normalize(ahead);
      const Vec3 way = path.speed * walk_per_second * seconds * glm::length(ahead) * along;
      camera.eye += way, camera.target += way;
      break;
    }
    case CameraPath::keys:
      return path.keys.camera_at(first, seconds);
  }
  return camera;
}

Light orbited(Light light, const Vec3& centre, const Vec3& up, double angle) {
  light.position = centre + turned(light.position - centre, up, angle);
  light.direction = turned(light.direction, up, angle);
  turn_shape(light.extent, [&](const Vec3& v) { return turned(v, up, angle); });
  return light;
}

// The half circle through east, the scene's own light and west.
Light sun_at(Light light, const Camera& camera, double angle_from_noon) {
  const Vec3 noon = -light.direction;
  Vec3 east = glm::cross(camera.up, noon);
  if (!(glm::length(east) > 1e-9 * glm::length(camera.up)))
    east = glm::cross(camera.target - camera.eye, noon);  // the light is at the zenith
  light.direction =
      -glm::normalize(std::cos(angle_from_noon) * noon - std::sin(angle_from_noon) * glm::normalize(east));
  return light;
}

}  // namespace

std::string_view camera_path_name(CameraPath path) {
  constexpr std::array<std::string_view, 6> names{"still", "orbit", "walk", "turn", "drift", "keys"};
  return names[static_cast<std::size_t>(path)];
}

std::string_view light_path_name(LightPath path) {
  constexpr std::array<std::string_view, 4> names{"still", "orbit", "sun", "keys"};
  return names[static_cast<std::size_t>(path)];
}

Expected<void> check_path(const ShimmerPath& path, const Scene& scene) {
  if (path.light == LightPath::sun &&
      std::none_of(scene.lights.begin(), scene.lights.end(),
                   [](const Light& light) { return light.type == LightType::directional; }))
    return fail(ErrorKind::usage, "--path sun: the scene has no directional light; orbit turns any");
  for (const auto& [name, keys] : path.keys.lights) {
    const auto light = std::find_if(scene.lights.begin(), scene.lights.end(),
                                    [&name = name](const Light& each) { return each.name == name; });
    if (light == scene.lights.end())
      return fail(ErrorKind::bad_input, fmt::format("--path: the scene has no light \"{}\"", name));
    if (keys.position && light->type == LightType::directional)
      return fail(ErrorKind::bad_input,
                  fmt::format("--path: the light \"{}\" is directional and has no position", name));
    if (keys.direction && light->type == LightType::point)
      return fail(ErrorKind::bad_input,
                  fmt::format("--path: the light \"{}\" is a point and has no direction", name));
  }
  return {};
}

Pose pose_at(const ShimmerPath& path, const FilmTime& time, const Pose& first, const Vec3& centre,
             int frame) {
  const double seconds = time.seconds(frame), angle = path.speed * turn_per_second * seconds;
  Pose pose{moved_camera(path, first.camera, seconds), first.lights};
  const Vec3 up = glm::normalize(first.camera.up);
  for (Light& light : pose.lights) {
    if (path.light == LightPath::orbit) light = orbited(light, centre, up, angle);
    if (path.light == LightPath::sun && light.type == LightType::directional)
      light = sun_at(light, first.camera, path.speed * day * (time.share(frame) - 0.5));
    if (path.light == LightPath::keys) light = path.keys.light_at(light, seconds);
  }
  return pose;
}

Expected<void> check_pose(const Pose& pose, int frame) {
  for (const Light& light : pose.lights)
    if (!std::isfinite(glm::length(light.direction)))
      return fail(ErrorKind::bad_input,
                  fmt::format("--path: in frame {} the light \"{}\" has no direction: between its keys it "
                              "passes through zero",
                              frame, light.name));
  const Vec3 ahead = pose.camera.target - pose.camera.eye;
  if (glm::length(glm::cross(ahead, pose.camera.up)) >
      1e-9 * glm::length(ahead) * glm::length(pose.camera.up))
    return {};
  return fail(
      ErrorKind::bad_input,
      fmt::format("--path: in frame {} the camera looks at its own eye or along its up vector", frame));
}

}  // namespace gnomon::compare
