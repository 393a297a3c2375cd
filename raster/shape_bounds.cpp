#include "raster/shape_bounds.h"

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

}  // namespace

std::optional<ClipRectangle> shape_bounds(const Projection& projection, const Shape& shape) {
  const auto* sphere = std::get_if<Sphere>(&shape.geometry);
  if (sphere == nullptr) return ClipRectangle{};
  const Vec3 d = sphere->center - projection.origin;
  const Vec3 c(glm::dot(d, projection.frame.right), glm::dot(d, projection.frame.up),
               glm::dot(d, projection.frame.forward));
  const double r = sphere->radius;
  if (projection.perspective && c.z + r <= 0.0) return std::nullopt;
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

}  // namespace gnomon::raster
