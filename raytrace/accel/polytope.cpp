#include "raytrace/accel/polytope.h"

#include <algorithm>

namespace gnomon::raytrace {
namespace {

double polygon_area(const std::vector<Vec3>& polygon) {
  Vec3 twice(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice = twice + glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * glm::length(twice);
}

/// Sutherland and Hodgman 1974; the points where edges cross the plane are added to `crossings`.
void polygon_below(const std::vector<Vec3>& polygon, const CutPlane& plane, std::vector<Vec3>& out,
                   std::vector<Vec3>& crossings) {
  out.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double ha = plane.height(a), hb = plane.height(b);
    if (ha <= 0.0) out.push_back(a);
    if ((ha <= 0.0) == (hb <= 0.0)) continue;
    const Vec3 crossing = a + (ha / (ha - hb)) * (b - a);
    out.push_back(crossing);
    crossings.push_back(crossing);
  }
}

/// Returns the area of the new face, from its edges in any order: each face that was cut gave one edge, two crossings in a
/// row.
double lid_area(const std::vector<Vec3>& crossings) {
  Vec3 middle(0.0);
  for (const Vec3& p : crossings) middle = middle + p / static_cast<double>(crossings.size());
  double area = 0.0;
  for (std::size_t i = 1; i < crossings.size(); i += 2)
    area += 0.5 * glm::length(glm::cross(crossings[i - 1] - middle, crossings[i] - middle));
  return area;
}

/// The crossings of a convex cell lie on a convex polygon: in order around its middle.
std::vector<Vec3> in_order(std::vector<Vec3> points, const Vec3& normal) {
  if (points.size() < 3) return {};
  Vec3 middle(0.0);
  for (const Vec3& p : points) middle = middle + p / static_cast<double>(points.size());
  const Vec3 x = glm::cross(normal, std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
  const Vec3 y = glm::cross(normal, x);
  const auto angle = [&](const Vec3& p) {
    return std::atan2(glm::dot(p - middle, y), glm::dot(p - middle, x));
  };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  return points;
}

}  // namespace

Polytope::Polytope(const CellBox& box) {
  for (std::size_t a = 0; a < 3; ++a)
    for (const float wall : {box.min[a], box.max[a]}) {
      const std::size_t u = (a + 1) % 3, v = (a + 2) % 3;
      Face face;
      for (const auto& [at_u, at_v] : {std::pair{box.min[u], box.min[v]},
                                       {box.max[u], box.min[v]},
                                       {box.max[u], box.max[v]},
                                       {box.min[u], box.max[v]}}) {
        Vec3 corner(0.0);
        corner[static_cast<int>(a)] = wall, corner[static_cast<int>(u)] = at_u,
        corner[static_cast<int>(v)] = at_v;
        face.push_back(corner);
      }
      area_ += polygon_area(face);
      faces_.push_back(std::move(face));
    }
}

std::array<double, 2> Polytope::areas_of_parts(const CutPlane& plane, CutBuffers& buffers) const {
  buffers.crossings.clear();
  double below = 0.0;
  for (const Face& face : faces_) {
    polygon_below(face, plane, buffers.polygon, buffers.crossings);
    below += polygon_area(buffers.polygon);
  }
  const double cut = lid_area(buffers.crossings);
  return {below + cut, std::max(0.0, area_ - below) + cut};
}

Polytope Polytope::cut(const CutPlane& plane) const {
  std::vector<Vec3> crossings;
  Polytope out;
  for (const Face& face : faces_) {
    Face part;
    polygon_below(face, plane, part, crossings);
    if (part.size() >= 3) out.faces_.push_back(std::move(part));
  }
  if (Face lid = in_order(std::move(crossings), plane.normal); !lid.empty())
    out.faces_.push_back(std::move(lid));
  for (const Face& face : out.faces_) out.area_ += polygon_area(face);
  return out;
}

}  // namespace gnomon::raytrace
