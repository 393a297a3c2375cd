#include "app/pose.h"

#include <cmath>

namespace gnomon::app {

namespace {

double radians(double degrees) {
  return degrees * pi / 180.0;
}

/// What angles are measured from: azimuth 0 is `zero`, azimuth 90 is `quarter`, elevation 90 is `pole`.
struct PoleFrame {
  Vec3 zero, quarter, pole;
};

constexpr Vec3 x_axis{1.0, 0.0, 0.0}, y_axis{0.0, 1.0, 0.0}, z_axis{0.0, 0.0, 1.0};

/// For a pole along y this is (z, x, y).
PoleFrame frame_about(const Vec3& up) {
  const Vec3 pole = glm::normalize(up);
  const bool along_x = std::abs(pole.x) > std::abs(pole.y) && std::abs(pole.x) > std::abs(pole.z);
  const Vec3 zero = glm::normalize(glm::cross(along_x ? z_axis : x_axis, pole));
  return {zero, glm::cross(pole, zero), pole};
}

struct Spherical {
  double azimuth = 0.0, elevation = 0.0, distance = 0.0;  // radians, world units
};

Spherical spherical(const PoleFrame& frame, const Vec3& v) {
  const double along_zero = glm::dot(v, frame.zero), along_quarter = glm::dot(v, frame.quarter);
  const double height = glm::dot(v, frame.pole);
  return {std::atan2(along_quarter, along_zero), std::atan2(height, std::hypot(along_zero, along_quarter)),
          glm::length(v)};
}

/// Unit vectors outwards, towards growing azimuth, and towards growing elevation.
struct LocalFrame {
  Vec3 outwards, east, north;
};

LocalFrame local_frame(const PoleFrame& frame, double azimuth_degrees, double elevation_degrees) {
  const double a = radians(azimuth_degrees), e = radians(elevation_degrees);
  const Vec3 horizontal = std::cos(a) * frame.zero + std::sin(a) * frame.quarter;
  const Vec3 east = std::cos(a) * frame.quarter - std::sin(a) * frame.zero;
  return {std::cos(e) * horizontal + std::sin(e) * frame.pole, east,
          std::cos(e) * frame.pole - std::sin(e) * horizontal};
}

}  // namespace

double wrapped_degrees(double angle) {
  const double turned = std::remainder(angle, 360.0);
  return turned <= -180.0 ? turned + 360.0 : turned;
}

CameraPose camera_pose(const Camera& camera) {
  const Spherical s = spherical(frame_about(camera.up), camera.eye - camera.target);
  return {degrees(s.azimuth), degrees(s.elevation), s.distance};
}

Camera posed_camera(const Camera& given, const CameraPose& pose) {
  Camera camera = given;
  camera.up = pose.up.value_or(given.up);
  camera.orthographic_height = pose.height.value_or(given.orthographic_height);
  const LocalFrame local = local_frame(frame_about(camera.up), pose.azimuth_degrees, pose.elevation_degrees);
  camera.target = pose.target.value_or(given.target);
  camera.eye = camera.target + pose.distance * local.outwards;
  return camera;
}

LightPose light_pose(const Light& light, const Vec3& centre) {
  const Vec3 towards = light.type == LightType::directional ? -light.direction : light.position - centre;
  const Spherical s = spherical(frame_about(y_axis), towards);
  return {degrees(s.azimuth), degrees(s.elevation)};
}

Light resized_light(const Light& given, double size) {
  Light light = given;
  if (resize_shape(light.extent, size)) return light;
  if (light.type == LightType::directional)
    light.extent = SunDisc{};
  else
    light.extent = SphereLight{};
  resize_shape(light.extent, size);
  return light;
}

Light posed_light(const Light& given, const Vec3& centre, const LightPose& pose) {
  Light light = pose.size ? resized_light(given, *pose.size) : given;
  const LightPose before = light_pose(given, centre);
  const bool turns =
      pose.azimuth_degrees != before.azimuth_degrees || pose.elevation_degrees != before.elevation_degrees;
  if (!turns && !pose.distance) return light;  // without rounding
  const PoleFrame frame = frame_about(y_axis);
  const LocalFrame to = local_frame(frame, pose.azimuth_degrees, pose.elevation_degrees);
  if (given.type == LightType::directional) {
    light.direction = -glm::normalize(to.outwards);
    return light;
  }
  const LocalFrame from = local_frame(frame, before.azimuth_degrees, before.elevation_degrees);
  light.position = centre + pose.distance.value_or(glm::length(given.position - centre)) * to.outwards;
  const auto turned = [&](const Vec3& v) {
    return glm::dot(v, from.outwards) * to.outwards + glm::dot(v, from.east) * to.east +
           glm::dot(v, from.north) * to.north;
  };
  light.direction = glm::normalize(turned(given.direction));
  turn_shape(light.extent, turned);
  return light;
}

}  // namespace gnomon::app
