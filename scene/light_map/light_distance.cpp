// How near to a light the nearest surface is, and how far the farthest.

#include "scene/light_map/light_fit_parts.h"
#include "scene/shapes/solid.h"
#include "scene/shapes/triangle_blocks.h"

namespace gnomon::light_fit {
namespace {

// Ericson 2005, Real-Time Collision Detection, section 5.1.5.
double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const auto& [a, b, c] = t;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return glm::length(ap);
  const Vec3 bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return glm::length(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return glm::length(ap - ab * (d1 / (d1 - d3)));
  const Vec3 cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return glm::length(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return glm::length(ap - ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return glm::length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const Vec3 n = glm::cross(ab, ac);
  return std::abs(glm::dot(n, ap)) / glm::length(n);
}

// To the solid's box: less than to the solid.
double distance_to_box(const Vec3& p, const ShapeGeometry& solid) {
  const Aabb box = local_box(solid);
  const Vec3 local = to_local(frame_of(solid), p);
  return glm::length(local - glm::clamp(local, box.min, box.max));
}

}  // namespace

double closest_distance(const World& world, const Vec3& p) {
  const auto is_farther = [&](double closest, const Aabb& box) {
    return 0.999 * glm::length(p - glm::clamp(p, box.min, box.max)) > closest;
  };
  const auto keep_less = [](double& closest, double other) { closest = std::min(closest, other); };
  double closest = over_blocks(
      world, infinity, is_farther,
      [&](double& sum, const WorldPart& part, std::uint32_t triangle) {
        keep_less(sum, distance_to_triangle(p, part.corners(triangle)));
      },
      keep_less);
  for (const Shape& shape : world.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      closest = std::min(closest, std::abs(glm::length(sphere->center - p) - sphere->radius));
    else if (is_solid(shape.geometry))
      closest = std::min(closest, distance_to_box(p, shape.geometry));
    else {
      const auto& plane = std::get<Plane>(shape.geometry);
      closest = std::min(closest, std::abs(glm::dot(plane.normal, plane.point - p)));
    }
  }
  return closest;
}

double farthest_distance(const World& world, const Vec3& p) {
  const auto is_nearer = [&](double farthest, const Aabb& box) {
    return 1.001 * glm::length(glm::max(glm::abs(box.min - p), glm::abs(box.max - p))) < farthest;
  };
  const auto keep_more = [](double& farthest, double other) { farthest = std::max(farthest, other); };
  double farthest = over_blocks(
      world, 0.0, is_nearer,
      [&](double& sum, const WorldPart& part, std::uint32_t triangle) {
        for (const Vec3& corner : part.corners(triangle)) keep_more(sum, glm::length(corner - p));
      },
      keep_more);
  for (const Shape& shape : world.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      farthest = std::max(farthest, glm::length(sphere->center - p) + sphere->radius);
    else if (is_solid(shape.geometry))
      farthest = std::max(farthest, glm::length(solid_center(shape.geometry) - p) +
                                        0.5 * local_box(shape.geometry).diagonal());
  }
  return farthest;
}

}  // namespace gnomon::light_fit
