#include "scene/camera.h"

namespace gnomon {

View make_view(const Camera& camera, ImageSize size) {
  View view;
  view.eye = camera.eye;
  view.forward = glm::normalize(camera.target - camera.eye);
  view.right = glm::normalize(glm::cross(view.forward, camera.up));
  view.up = glm::cross(view.right, view.forward);
  view.tan_half_y = std::tan(0.5 * camera.vertical_fov);
  view.tan_half_x = view.tan_half_y * size.width / size.height;
  view.size = size;
  return view;
}

Ray pixel_ray(const View& view, double x, double y) {
  const double sx = (2.0 * x / view.size.width - 1.0) * view.tan_half_x;
  const double sy = (1.0 - 2.0 * y / view.size.height) * view.tan_half_y;
  return {view.eye, glm::normalize(view.forward + sx * view.right + sy * view.up)};
}

Vec3 project_to_pixels(const View& view, const Vec3& world) {
  const Vec3 d = world - view.eye;
  const double z = glm::dot(d, view.forward);
  const double sx = glm::dot(d, view.right) / (z * view.tan_half_x);
  const double sy = glm::dot(d, view.up) / (z * view.tan_half_y);
  return {0.5 * (sx + 1.0) * view.size.width, 0.5 * (1.0 - sy) * view.size.height, z};
}

Mat4 view_from_eye_relative(const View& view) {
  const Mat3 view_from_world = glm::transpose(Mat3(view.right, view.up, -view.forward));
  return Mat4(view_from_world);
}

Mat4 clip_from_view(const View& view, double near_distance) {
  Mat4 m(0.0);
  m[0][0] = 1.0 / view.tan_half_x;
  m[1][1] = 1.0 / view.tan_half_y;
  m[2][3] = -1.0;
  m[3][2] = near_distance;
  return m;
}

}  // namespace gnomon
