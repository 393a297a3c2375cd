#include "scene/light_view.h"

namespace gnomon {

int cube_face(const Vec3& d) {
  const Vec3 a = glm::abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
  return d.z >= 0.0 ? 4 : 5;
}

TexelCoordinate project_to_texel(const LightView& view, const Vec3& world) {
  return project_to_face(view, view.face_count == 6 ? cube_face(world - view.origin) : 0, world);
}

TexelCoordinate project_to_face(const LightView& view, int face_index, const Vec3& world) {
  TexelCoordinate t;
  t.face = face_index;
  const Vec3 d = world - view.origin;
  const LightFace& face = view.faces[static_cast<std::size_t>(t.face)];
  t.depth = glm::dot(d, face.forward);
  const bool perspective = view.projection == LightProjection::perspective;
  t.distance = perspective ? glm::length(d) : t.depth;
  const double w = perspective ? t.depth : 1.0;
  const double x = glm::dot(d, face.right) / (w * view.half_extent.x);
  const double y = glm::dot(d, face.up) / (w * view.half_extent.y);
  t.u = 0.5 * (x + 1.0) * view.size;
  t.v = 0.5 * (y + 1.0) * view.size;
  t.inside = w > 0.0 && t.u >= 0.0 && t.v >= 0.0 && t.u < view.size && t.v < view.size;
  return t;
}

Ray texel_ray(const LightView& view, int face_index, double u, double v) {
  const LightFace& face = view.faces[static_cast<std::size_t>(face_index)];
  const Vec3 offset = (2.0 * u / view.size - 1.0) * view.half_extent.x * face.right +
                      (2.0 * v / view.size - 1.0) * view.half_extent.y * face.up;
  if (view.projection == LightProjection::orthographic)
    return {view.origin + offset, face.forward, {-infinity, infinity}};
  return {view.origin, glm::normalize(face.forward + offset), {0.0, infinity}};
}

double texel_world_size(const LightView& view, double depth) {
  const double w = view.projection == LightProjection::perspective ? depth : 1.0;
  return 2.0 * std::max(view.half_extent.x, view.half_extent.y) * w / view.size;
}

namespace {

// The plane x = tangent * depth through the light (perspective) or x = offset (orthographic), keeping the
// side of growing x for sign = 1.
HalfSpace column_plane(const LightView& view, const Vec3& axis, const Vec3& forward, double bound,
                       double sign) {
  if (view.projection == LightProjection::orthographic) return {sign * axis, sign * bound};
  return {glm::normalize(sign * (axis - bound * forward)), 0.0};
}

}  // namespace

std::array<HalfSpace, 4> column_planes(const LightView& view, int face_index, int column, int row) {
  const LightFace& f = view.faces[static_cast<std::size_t>(face_index)];
  const auto edge = [&](int i, double half) { return (2.0 * i / view.size - 1.0) * half; };
  return {column_plane(view, f.right, f.forward, edge(column, view.half_extent.x), 1.0),
          column_plane(view, f.right, f.forward, edge(column + 1, view.half_extent.x), -1.0),
          column_plane(view, f.up, f.forward, edge(row, view.half_extent.y), 1.0),
          column_plane(view, f.up, f.forward, edge(row + 1, view.half_extent.y), -1.0)};
}

double stored_from_depth(const LightView& view, double z) {
  const double n = view.near_depth;
  const double f = view.far_depth;
  if (view.projection == LightProjection::orthographic) return (z - n) / (f - n);
  return f * (z - n) / (z * (f - n));
}

double depth_from_stored(const LightView& view, double s) {
  const double n = view.near_depth;
  const double f = view.far_depth;
  if (view.projection == LightProjection::orthographic) return n + s * (f - n);
  return n * f / (f - s * (f - n));
}

Mat4 light_clip_from_relative(const LightView& view, int face_index, const Vec3& reference) {
  const LightFace& face = view.faces[static_cast<std::size_t>(face_index)];
  const Vec3 shift = reference - view.origin;
  Mat4 light_from_relative(1.0);
  const std::array<Vec3, 3> axes{face.right, face.up, face.forward};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      light_from_relative[column][row] = axes[static_cast<std::size_t>(row)][column];
    light_from_relative[3][row] = glm::dot(axes[static_cast<std::size_t>(row)], shift);
  }
  const double n = view.near_depth;
  const double f = view.far_depth;
  Mat4 clip_from_light(0.0);
  clip_from_light[0][0] = 1.0 / view.half_extent.x;
  clip_from_light[1][1] = 1.0 / view.half_extent.y;
  if (view.projection == LightProjection::orthographic) {
    clip_from_light[2][2] = 1.0 / (f - n);
    clip_from_light[3][2] = -n / (f - n);
    clip_from_light[3][3] = 1.0;
  } else {
    clip_from_light[2][2] = f / (f - n);
    clip_from_light[3][2] = -n * f / (f - n);
    clip_from_light[2][3] = 1.0;
  }
  return clip_from_light * light_from_relative;
}

}  // namespace gnomon
