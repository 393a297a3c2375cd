#include "scene/camera.h"

namespace gnomon {

Vec3 View::ray_origin(const Vec2& place) const {
  if (!orthographic()) return eye;
  return eye + place.x * half_x * right + place.y * half_y * up;
}

Vec3 View::ray_direction(const Vec2& place) const {
  if (orthographic()) return forward;
  return forward + place.x * tan_half_x * right + place.y * tan_half_y * up;
}

double View::distance(const Vec3& world) const {
  return orthographic() ? glm::dot(world - eye, forward) : glm::length(world - eye);
}

View make_view(const Camera& camera, ImageSize size) {
  View view;
  view.eye = camera.eye;
  view.forward = glm::normalize(camera.target - camera.eye);
  view.right = glm::normalize(glm::cross(view.forward, camera.up));
  view.up = glm::cross(view.right, view.forward);
  view.half_y = 0.5 * camera.orthographic_height;
  view.half_x = view.half_y * size.width / size.height;
  view.tan_half_y = camera.orthographic() ? 0.0 : std::tan(0.5 * camera.vertical_fov);
  view.tan_half_x = view.tan_half_y * size.width / size.height;
  view.size = size;
  return view;
}

double picture_height(const Camera& camera, double depth) {
  return camera.orthographic() ? camera.orthographic_height
                               : 2.0 * depth * std::tan(0.5 * camera.vertical_fov);
}

Camera narrowed(const Camera& camera, double share) {
  Camera out = camera;
  out.orthographic_height *= share;
  out.vertical_fov = 2.0 * std::atan(std::tan(0.5 * camera.vertical_fov) * share);
  return out;
}

Ray pixel_ray(const View& view, double x, double y) {
  const Vec2 place(2.0 * x / view.size.width - 1.0, 1.0 - 2.0 * y / view.size.height);
  if (view.orthographic()) return {view.ray_origin(place), view.forward};
  return {view.eye, glm::normalize(view.ray_direction(place))};
}

Vec3 project_to_pixels(const View& view, const Vec3& world) {
  const Vec3 d = world - view.eye;
  const double z = glm::dot(d, view.forward);
  const double sx = glm::dot(d, view.right) / (view.half_x + z * view.tan_half_x);
  const double sy = glm::dot(d, view.up) / (view.half_y + z * view.tan_half_y);
  return {0.5 * (sx + 1.0) * view.size.width, 0.5 * (1.0 - sy) * view.size.height, z};
}

Ray ray_to(const View& view, const Vec3& world) {
  if (view.orthographic()) return {world - view.distance(world) * view.forward, view.forward};
  return {view.eye, glm::normalize(world - view.eye)};
}

double pixel_footprint(const View& view, double distance) {
  return 2.0 * (view.half_y + view.tan_half_y * distance) / view.size.height;
}

Mat4 view_from_eye_relative(const View& view) {
  const Mat3 view_from_world = glm::transpose(Mat3(view.right, view.up, -view.forward));
  return Mat4(view_from_world);
}

Mat4 clip_from_view(const View& view, double reach) {
  Mat4 m(0.0);
  if (view.orthographic()) {
    m[0][0] = 1.0 / view.half_x;
    m[1][1] = 1.0 / view.half_y;
    m[2][2] = 1.0 / reach;
    m[3][2] = m[3][3] = 1.0;
    return m;
  }
  m[0][0] = 1.0 / view.tan_half_x;
  m[1][1] = 1.0 / view.tan_half_y;
  m[2][3] = -1.0;
  m[3][2] = reach;
  return m;
}

}  // namespace gnomon
