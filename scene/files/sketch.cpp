#include "scene/files/sketch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace gnomon {
namespace {

/// At most four corners, each of whose sides the near plane may cut.
struct Polygon {
  std::array<Vec3, 8> corners;
  std::size_t count = 0;
  void add(const Vec3& p) { corners[count++] = p; }
};

/// The part of a convex polygon that lies farther than `near` before the eye.
Polygon beyond(const View& view, std::span<const Vec3> corners, double near) {
  Polygon out;
  const auto depth = [&](const Vec3& p) { return glm::dot(p - view.eye, view.forward) - near; };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double from = depth(a), to = depth(b);
    if (from >= 0.0) out.add(a);
    if ((from >= 0.0) != (to >= 0.0)) out.add(a + from / (from - to) * (b - a));
  }
  return out;
}

}  // namespace

Sketch::Sketch(const View& view)
    : view_(view),
      part_(static_cast<std::size_t>(view.size.width) * static_cast<std::size_t>(view.size.height), nothing),
      depth_(part_.size(), infinity) {}

void Sketch::draw_triangle(const PlacedTriangle& t, std::uint32_t part, bool shows_back) {
  draw_polygon(std::array{t.a, t.turn < 0.0 ? t.c : t.b, t.turn < 0.0 ? t.b : t.c}, part, shows_back);
}

// The corners run counter-clockwise around the front.
void Sketch::draw_polygon(std::span<const Vec3> corners, std::uint32_t part, bool shows_back) {
  double farthest = 0.0;
  for (const Vec3& p : corners) farthest = std::max(farthest, glm::dot(p - view_.eye, view_.forward));
  if (!(farthest > 0.0)) return;
  constexpr double near_share = 1e-6;  // of the polygon's farthest depth
  const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const Polygon before = beyond(view_, corners, near_share * farthest);
  std::array<Vec2, 8> seen;
  Vec2 low(infinity), high(-infinity);
  for (std::size_t i = 0; i < before.count; ++i) {
    seen[i] = Vec2(project_to_pixels(view_, before.corners[i]));
    low = glm::min(low, seen[i]), high = glm::max(high, seen[i]);
  }
  if (before.count < 3 || !std::isfinite(low.x + low.y + high.x + high.y)) return;
  const auto first = [](double least, int size) {
    return static_cast<int>(std::clamp(std::ceil(least - 0.5), 0.0, double(size)));
  };
  const auto last = [](double most, int size) {
    return static_cast<int>(std::clamp(std::floor(most - 0.5), -1.0, double(size - 1)));
  };
  for (int y = first(low.y, view_.size.height); y <= last(high.y, view_.size.height); ++y)
    for (int x = first(low.x, view_.size.width); x <= last(high.x, view_.size.width); ++x) {
      const Vec2 middle(x + 0.5, y + 0.5);
      bool left = true, right = true;
      for (std::size_t i = 0; i < before.count; ++i) {
        const Vec2 side = seen[(i + 1) % before.count] - seen[i], to = middle - seen[i];
        const double turn = side.x * to.y - side.y * to.x;
        left = left && turn >= 0.0, right = right && turn <= 0.0;
      }
      if (!left && !right) continue;
      const Vec3 direction = view_.ray_direction(place(x, y));
      const double along = glm::dot(normal, direction);
      if (along == 0.0 || (along > 0.0 && !shows_back)) continue;
      const double depth = glm::dot(normal, corners[0] - view_.ray_origin(place(x, y))) / along;
      put(static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.size.width) +
              static_cast<std::size_t>(x),
          depth, part);
    }
}

void Sketch::draw_shape(const Shape& shape, std::uint32_t part) {
  const auto* sphere = std::get_if<Sphere>(&shape.geometry);
  if (sphere == nullptr) {
    const Aabb box = box_of(shape);
    constexpr std::array<std::array<int, 4>, 6> sides{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    const auto corner = [&](int i) {
      return Vec3((i & 1) ? box.max.x : box.min.x, (i & 2) ? box.max.y : box.min.y,
                  (i & 4) ? box.max.z : box.min.z);
    };
    for (const auto& side : sides)
      draw_polygon(std::array{corner(side[0]), corner(side[1]), corner(side[2]), corner(side[3])}, part,
                   true);
    return;
  }
  std::size_t pixel = 0;
  for (int y = 0; y < view_.size.height; ++y)
    for (int x = 0; x < view_.size.width; ++x, ++pixel) {
      const Vec3 d = view_.ray_direction(place(x, y)), o = view_.ray_origin(place(x, y)) - sphere->center;
      const double a = glm::dot(d, d), b = glm::dot(o, d),
                   c = glm::dot(o, o) - sphere->radius * sphere->radius;
      if (b * b < a * c) continue;
      const double root = std::sqrt(b * b - a * c);
      put(pixel, (-b - root > 0.0 ? -b - root : -b + root) / a, part);
    }
}

void Sketch::draw_plane(const Plane& plane) {
  std::size_t pixel = 0;
  for (int y = 0; y < view_.size.height; ++y)
    for (int x = 0; x < view_.size.width; ++x, ++pixel) {
      const double along = glm::dot(plane.normal, view_.ray_direction(place(x, y)));
      if (along != 0.0)
        put(pixel, glm::dot(plane.normal, plane.point - view_.ray_origin(place(x, y))) / along, nothing);
    }
}

}  // namespace gnomon
