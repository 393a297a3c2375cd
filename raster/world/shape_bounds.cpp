#include "raster/world/shape_bounds.h"

#include <array>

namespace gnomon::raster {
namespace {

// The range of x/z over the disc of radius r around (x, z): slopes of the tangents from the origin. Whole
// line when the disc reaches z <= 0.
Interval slopes(double x, double z, double r) {
  if (!(z > r)) return {-infinity, infinity};
  const double root = r * std::sqrt(std::max(0.0, x * x + z * z - r * r));
  const double scale = 1.0 / (z * z - r * r);
  return {(x * z - root) * scale, (x * z + root) * scale};
}

// The bounding rectangle of the image's part whose rays meet the plane ahead of a perspective origin. It is the
// image clipped at the plane's horizon, where the direction's component towards the plane is zero (it is
// linear over the image).
std::optional<ClipRectangle> plane_bounds(const Projection& projection, const Plane& plane) {
  if (!projection.perspective) return ClipRectangle{};
  const double height = glm::dot(plane.normal, plane.point - projection.origin);
  const Vec3 towards = height < 0.0 ? -plane.normal : plane.normal;
  const double base = glm::dot(towards, projection.frame.forward);
  const Vec2 slope = projection.half_extent *
                     Vec2(glm::dot(towards, projection.frame.right), glm::dot(towards, projection.frame.up));
  constexpr std::array<Vec2, 4> corners{Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)};
  ClipRectangle out{Vec2(infinity), Vec2(-infinity)};
  const auto grow = [&](const Vec2& p) { out.min = glm::min(out.min, p), out.max = glm::max(out.max, p); };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 b = corners[(i + 1) % corners.size()];
    const double ha = base + glm::dot(slope, a);
    const double hb = base + glm::dot(slope, b);
    if (ha > 0.0) grow(a);
    if ((ha > 0.0) != (hb > 0.0)) grow(a + (b - a) * (ha / (ha - hb)));
  }
  if (!(out.min.x <= out.max.x)) return std::nullopt;
  out.min = glm::max(out.min - projection.pixel, Vec2(-1.0));
  out.max = glm::min(out.max + projection.pixel, Vec2(1.0));
  return out;
}

// Of the square around a disc on a warped orthographic face (light_view.h): its corners bound it, for lines
// stay lines.
std::optional<ClipRectangle> warped_bounds(const Projection& projection, const Vec2& c, double r) {
  const double warp = projection.frame.warp;
  const Vec2 half = projection.half_extent;
  if (!(1.0 + warp * (c.y - r) > 0.0)) return ClipRectangle{};
  ClipRectangle out{Vec2(infinity), Vec2(-infinity)};
  for (const Vec2 side : {Vec2(-r, -r), Vec2(r, -r), Vec2(r, r), Vec2(-r, r)}) {
    const Vec2 p = c + side;
    const Vec2 shown = Vec2(p.x, p.y + warp * half.y * half.y) / (half * (1.0 + warp * p.y));
    out.min = glm::min(out.min, shown - projection.pixel),
    out.max = glm::max(out.max, shown + projection.pixel);
  }
  out.min = glm::max(out.min, Vec2(-1.0)), out.max = glm::min(out.max, Vec2(1.0));
  if (!(out.min.x < out.max.x && out.min.y < out.max.y)) return std::nullopt;
  return out;
}

std::optional<ClipRectangle> sphere_bounds(const Projection& projection, const Sphere& sphere) {
  const Vec3 d = sphere.center - projection.origin;
  const Vec3 c(glm::dot(d, projection.frame.right), glm::dot(d, projection.frame.up),
               glm::dot(d, projection.frame.forward));
  const double r = sphere.radius;
  if (projection.perspective && c.z + r <= 0.0) return std::nullopt;
  if (projection.frame.warp != 0.0) return warped_bounds(projection, Vec2(c), r);
  ClipRectangle out;
  for (int axis = 0; axis < 2; ++axis) {
    const Interval range =
        projection.perspective ? slopes(c[axis], c.z, r) : Interval{c[axis] - r, c[axis] + r};
    out.min[axis] = std::max(-1.0, range.min / projection.half_extent[axis] - projection.pixel[axis]);
    out.max[axis] = std::min(1.0, range.max / projection.half_extent[axis] + projection.pixel[axis]);
    if (!(out.min[axis] < out.max[axis])) return std::nullopt;
  }
  return out;
}

// Of the solid's box. A box that reaches behind a perspective origin may fall anywhere.
std::optional<ClipRectangle> solid_bounds(const Projection& projection, const ShapeGeometry& solid) {
  const Aabb box = local_box(solid);
  const LightFace& frame = projection.frame;
  ClipRectangle out{Vec2(infinity), Vec2(-infinity)};
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 local((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                     (corner & 4) != 0 ? box.max.z : box.min.z);
    const Vec3 d = to_world(frame_of(solid), local) - projection.origin;
    const Vec3 c(glm::dot(d, frame.right), glm::dot(d, frame.up), glm::dot(d, frame.forward));
    const double w = projection.perspective ? c.z : 1.0 + frame.warp * c.y;
    if (!(w > 0.0)) {
      ++behind;
      continue;
    }
    const double lift = frame.warp * projection.half_extent.y * projection.half_extent.y;
    const Vec2 shown = Vec2(c.x, c.y + lift) / (w * projection.half_extent);
    out.min = glm::min(out.min, shown), out.max = glm::max(out.max, shown);
  }
  if (behind == 8) return std::nullopt;
  if (behind > 0) return ClipRectangle{};
  out.min = glm::max(out.min - projection.pixel, Vec2(-1.0));
  out.max = glm::min(out.max + projection.pixel, Vec2(1.0));
  if (!(out.min.x < out.max.x && out.min.y < out.max.y)) return std::nullopt;
  return out;
}

}  // namespace

Projection face_projection(const LightView& view, int face) {
  const LightFace& frame = view.face(face);
  return {face_origin(view, frame), frame, frame.half_extent, view.projection == LightProjection::perspective,
          Vec2(2.0 / view.size)};
}

std::optional<ClipRectangle> shape_bounds(const Projection& projection, const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return sphere_bounds(projection, *sphere);
  if (is_solid(shape.geometry) && projection.frame.warp != 0.0) {
    const Vec3 d = solid_center(shape.geometry) - projection.origin;
    return warped_bounds(projection,
                         Vec2(glm::dot(d, projection.frame.right), glm::dot(d, projection.frame.up)),
                         0.5 * local_box(shape.geometry).diagonal());
  }
  if (is_solid(shape.geometry)) return solid_bounds(projection, shape.geometry);
  return plane_bounds(projection, std::get<Plane>(shape.geometry));
}

Vec4 shape_in_frame(const Vec3& origin, const LightFace& frame, const Shape& shape) {
  const auto along_axes = [&](const Vec3& v) {
    return Vec3(glm::dot(v, frame.right), glm::dot(v, frame.up), glm::dot(v, frame.forward));
  };
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
    return Vec4(along_axes(sphere->center - origin), sphere->radius);
  if (is_solid(shape.geometry)) return Vec4(0.0);
  const auto& plane = std::get<Plane>(shape.geometry);
  return Vec4(along_axes(plane.normal), glm::dot(plane.normal, plane.point - origin));
}

Mat4 solid_from_frame(const Vec3& origin, const LightFace& frame, const ShapeGeometry& solid) {
  const Mat3 local_from_world = glm::transpose(frame_of(solid).axes);
  const Mat3 local_from_axes = local_from_world * Mat3(frame.right, frame.up, frame.forward);
  Mat4 out(local_from_axes);
  out[3] = Vec4(to_local(frame_of(solid), origin), 1.0);
  return out;
}

}  // namespace gnomon::raster
