#include "scene/files/polygon.h"

#include <numeric>

namespace gnomon {
namespace {

// Newell's normal: the sum of the cross products, robust for polygons that are not quite flat.
Vec3 newell_normal(std::span<const Vec3> corners) {
  Vec3 normal(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - corners[0];
    const Vec3 b = corners[(i + 1) % corners.size()] - corners[0];
    normal += glm::cross(a, b);
  }
  return normal;
}

// Without the axis along which the polygon is thinnest; counter-clockwise.
std::vector<Vec2> flatten(std::span<const Vec3> corners) {
  const Vec3 n = newell_normal(corners);
  const Vec3 size = glm::abs(n);
  const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (drop + 1) % 3;
  const int v = (drop + 2) % 3;
  std::vector<Vec2> flat;
  flat.reserve(corners.size());
  for (const Vec3& c : corners) {
    const Vec3 p = c - corners[0];  // far from the origin, differences keep the digits
    flat.push_back(n[drop] < 0.0 ? Vec2(p[v], p[u]) : Vec2(p[u], p[v]));
  }
  return flat;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

// The corners that are left, and which of them may be cut off.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2> flat) : flat_(std::move(flat)), left_(flat_.size()) {
    std::iota(left_.begin(), left_.end(), 0u);
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t start = 0;
    while (left_.size() >= 3) {
      const std::size_t ear = find_ear(start);
      triangles.push_back({at(ear + left_.size() - 1), at(ear), at(ear + 1)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      start = ear;
    }
    return triangles;
  }

 private:
  std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }

  // A crossing or degenerate polygon may have no ear left: then the next corner goes.
  std::size_t find_ear(std::size_t start) const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const std::size_t candidate = (start + i) % left_.size();
      if (is_ear(candidate)) return candidate;
    }
    return start % left_.size();
  }

  bool is_ear(std::size_t i) const {
    const Vec2 &a = flat_[at(i + left_.size() - 1)], &b = flat_[at(i)], &c = flat_[at(i + 1)];
    if (!(turn(a, b, c) > 0.0)) return false;
    for (const std::uint32_t other : left_) {
      const Vec2& p = flat_[other];
      if (p == a || p == b || p == c) continue;
      if (inside(p, a, b, c)) return false;
    }
    return true;
  }

  std::vector<Vec2> flat_;
  std::vector<std::uint32_t> left_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3> corners) {
  if (corners.size() == 3) return {{0, 1, 2}};
  return EarClipper(flatten(corners)).run();
}

}  // namespace gnomon
