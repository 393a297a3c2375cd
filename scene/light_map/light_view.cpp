#include "scene/light_map/light_view.h"

namespace gnomon {
namespace {

bool is_perspective(const LightView& view) {
  return view.projection == LightProjection::perspective;
}

// Height above the centre of a warped face, and back: the map shows (y + s b^2) / (1 + s y).
double unwarped(const LightFace& face, double shown) {
  const double b = face.half_extent.y;
  return (shown - face.warp * b * b) / (1.0 - face.warp * shown);
}

// 1 + s y, by which the map divides.
double warp_divisor(const LightFace& face, double y) {
  return 1.0 + face.warp * y;
}

// How far along an axis of the face a position in texels lies.
double across(const LightView& view, double texels, double half) {
  return (2.0 * texels / view.size - 1.0) * half;
}

// The share of the stored range that a warped face leaves to the ray at height v.
double warp_share(const LightView& view, const LightFace& face, double v) {
  if (face.warp == 0.0) return 1.0;
  const double y = unwarped(face, across(view, v, face.half_extent.y));
  return (1.0 - face.warp * face.half_extent.y) / warp_divisor(face, y);
}

struct StoredRange {
  double zero, one;  // the depths that are stored as 0 and 1
};

StoredRange range(const LightView& view, int face) {
  const LightFace& f = view.face(face);
  return view.reversed ? StoredRange{f.far_depth, f.near_depth} : StoredRange{f.near_depth, f.far_depth};
}

bool holds_neighbours(const LightView& view, const TexelCoordinate& t) {
  return t.u >= 1.0 && t.v >= 1.0 && t.u < view.size - 1.0 && t.v < view.size - 1.0;
}

}  // namespace

void LightView::set_extent(const Vec2& half_extent, double near_depth, double far_depth) {
  for (LightFace& face : faces)
    face.half_extent = half_extent, face.near_depth = near_depth, face.far_depth = far_depth;
}

Interval LightView::depth_range() const {
  Interval range{infinity, -infinity};
  for (int i = 0; i < face_count; ++i) {
    range.min = std::min(range.min, face(i).near_depth);
    range.max = std::max(range.max, face(i).far_depth);
  }
  return range;
}

std::array<Vec3, 8> face_corners(const LightView& view, int face) {
  const LightFace& f = view.face(face);
  const bool parallel = view.projection == LightProjection::orthographic;
  std::array<Vec3, 8> corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 at = corner_places[k % 4] * f.half_extent;
    const double depth = k < 4 ? f.near_depth : f.far_depth, wide = 1.0 + f.warp * at.y;
    corners[k] = parallel ? face_origin(view, f) + depth * f.forward + at.x * wide * f.right + at.y * f.up
                          : view.origin + depth * (f.forward + at.x * f.right + at.y * f.up);
  }
  return corners;
}

int cube_face(const Vec3& d) {
  const Vec3 a = glm::abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
  return d.z >= 0.0 ? 4 : 5;
}

std::array<LightFace, 6> cube_faces() {
  const auto face = [](Vec3 forward, Vec3 up) {
    LightFace out;
    out.right = glm::cross(forward, up), out.up = up, out.forward = forward;
    return out;
  };
  return {face({1, 0, 0}, {0, 1, 0}),  face({-1, 0, 0}, {0, 1, 0}), face({0, 1, 0}, {0, 0, 1}),
          face({0, -1, 0}, {0, 0, 1}), face({0, 0, 1}, {0, 1, 0}),  face({0, 0, -1}, {0, 1, 0})};
}

TexelCoordinate project_to_texel(const LightView& view, const Vec3& world) {
  if (is_perspective(view) && view.face_count == 6) {
    TexelCoordinate t = project_to_face(view, cube_face(world - view.origin), world);
    if (!view.seamless || !(t.depth > 0.0)) return t;
    const double last = std::nextafter(static_cast<double>(view.size), 0.0);
    t.u = std::clamp(t.u, 0.0, last), t.v = std::clamp(t.v, 0.0, last);
    t.inside = true;
    return t;
  }
  if (is_perspective(view)) return project_to_face(view, 0, world);
  return project_from_cascade(view, 0, world);
}

TexelCoordinate project_from_cascade(const LightView& view, int first, const Vec3& world) {
  for (int face = first; face + 1 < view.face_count; ++face) {
    const TexelCoordinate t = project_to_face(view, face, world);
    if (holds_neighbours(view, t)) return t;
  }
  return project_to_face(view, view.face_count - 1, world);
}

TexelCoordinate project_to_face(const LightView& view, int face_index, const Vec3& world) {
  TexelCoordinate t;
  t.face = face_index;
  const Vec3 d = world - view.origin;
  const LightFace& face = view.face(face_index);
  t.depth = glm::dot(d, face.forward);
  const bool perspective = is_perspective(view);
  t.distance = perspective ? glm::length(d) : t.depth;
  const double right = glm::dot(d, face.right) - face.center.x;
  double up = glm::dot(d, face.up) - face.center.y;
  const double w = perspective ? t.depth : warp_divisor(face, up);
  if (face.warp != 0.0) up += face.warp * face.half_extent.y * face.half_extent.y;
  const double x = right / (w * face.half_extent.x);
  const double y = up / (w * face.half_extent.y);
  t.u = 0.5 * (x + 1.0) * view.size;
  t.v = 0.5 * (y + 1.0) * view.size;
  t.inside = w > 0.0 && t.u >= 0.0 && t.v >= 0.0 && t.u < view.size && t.v < view.size;
  return t;
}

Ray texel_ray(const LightView& view, int face_index, double u, double v) {
  const LightFace& face = view.face(face_index);
  double x = across(view, u, face.half_extent.x);
  double y = across(view, v, face.half_extent.y);
  if (face.warp != 0.0) y = unwarped(face, y), x *= warp_divisor(face, y);
  const Vec3 offset = (x + face.center.x) * face.right + (y + face.center.y) * face.up;
  if (!is_perspective(view)) return {view.origin + offset, face.forward, {-infinity, infinity}};
  return {view.origin, glm::normalize(face.forward + offset), {0.0, infinity}};
}

double texel_world_size(const LightView& view, int face, double depth) {
  const double w = is_perspective(view) ? depth : 1.0;
  return 2.0 * std::max(view.face(face).half_extent.x, view.face(face).half_extent.y) * w / view.size;
}

double texel_world_size(const LightView& view, const TexelCoordinate& at) {
  const LightFace& face = view.face(at.face);
  if (face.warp == 0.0) return texel_world_size(view, at.face, at.depth);
  // dx/du = a (1 + s y); dy/dv = b (1 + s y)^2 / (1 - s^2 b^2).
  const double w = warp_divisor(face, unwarped(face, across(view, at.v, face.half_extent.y)));
  const double sb = face.warp * face.half_extent.y;
  const double tall = face.half_extent.y * w * w / (1.0 - sb * sb);
  return 2.0 * std::max(face.half_extent.x * w, tall) / view.size;
}

std::array<Vec2, 4> column_corners(const LightView& view, int face_index, int column, int row) {
  const LightFace& face = view.face(face_index);
  const auto corner = [&](int i, int j) {
    double x = across(view, i, face.half_extent.x), y = across(view, j, face.half_extent.y);
    if (face.warp != 0.0) y = unwarped(face, y), x *= warp_divisor(face, y);
    return Vec2(x + face.center.x, y + face.center.y);
  };
  return {corner(column, row), corner(column + 1, row), corner(column + 1, row + 1), corner(column, row + 1)};
}

double stored_from_depth(const LightView& view, int face, double v, double z) {
  const auto [n, f] = range(view, face);
  if (!is_perspective(view)) return (z - n) / (f - n) * warp_share(view, view.face(face), v);
  return f * (z - n) / (z * (f - n));
}

double depth_from_stored(const LightView& view, int face, double v, double s) {
  const auto [n, f] = range(view, face);
  if (!is_perspective(view)) return n + s / warp_share(view, view.face(face), v) * (f - n);
  return n * f / (f - s * (f - n));
}

Mat4 light_clip_from_relative(const LightView& view, int face_index, const Vec3& reference) {
  const LightFace& face = view.face(face_index);
  const Vec3 shift = reference - view.origin;
  Mat4 light_from_relative(1.0);
  const std::array<Vec3, 3> axes{face.right, face.up, face.forward};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      light_from_relative[column][row] = axes[static_cast<std::size_t>(row)][column];
    light_from_relative[3][row] = glm::dot(axes[static_cast<std::size_t>(row)], shift);
  }
  light_from_relative[3][0] -= face.center.x;
  light_from_relative[3][1] -= face.center.y;
  const auto [n, f] = range(view, face_index);
  Mat4 clip_from_light(0.0);
  clip_from_light[0][0] = 1.0 / face.half_extent.x;
  clip_from_light[1][1] = 1.0 / face.half_extent.y;
  if (is_perspective(view)) {
    clip_from_light[2][2] = f / (f - n);
    clip_from_light[3][2] = -n * f / (f - n);
    clip_from_light[2][3] = 1.0;
  } else {
    const double share = 1.0 - face.warp * face.half_extent.y;
    clip_from_light[2][2] = share / (f - n);
    clip_from_light[3][2] = share * -n / (f - n);
    clip_from_light[1][3] = face.warp;
    clip_from_light[3][1] = face.warp * face.half_extent.y;
    clip_from_light[3][3] = 1.0;
  }
  return clip_from_light * light_from_relative;
}

}  // namespace gnomon
