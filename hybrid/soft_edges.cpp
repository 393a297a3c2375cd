#include "hybrid/soft_edges.h"

#include "raytrace/precision/error_bounds.h"
#include "scene/base/parallel.h"

namespace gnomon::hybrid {
namespace {

constexpr std::uint32_t leaf_edges = 4;

/// The side of the triangle's plane that the whole light lies on: 1, -1, or 0 where it may lie on both.
int side_of_light(const std::array<Vec3, 3>& corners, const LightHull& hull, double position_error) {
  const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const Vec3 n = glm::cross(e1, e2);
  const double s1 = raytrace::max_component(glm::abs(e1)), s2 = raytrace::max_component(glm::abs(e2));
  const double n_error =
      4.0 * (position_error * (s1 + s2 + position_error) + raytrace::error_gamma(16) * s1 * s2);
  bool above = true, below = true;
  for (const Vec3& corner : hull.corners) {
    const Vec3 d = corner - corners[0];
    const double size = glm::dot(glm::abs(d), Vec3(1.0));
    const double bound = n_error * size + 2.0 * position_error * glm::dot(glm::abs(n), Vec3(1.0)) +
                         raytrace::error_gamma(16) * glm::dot(glm::abs(n), glm::abs(d));
    const double value = glm::dot(n, d);
    above = above && value > bound, below = below && value < -bound;
  }
  return above ? 1 : below ? -1 : 0;
}

bool may_touch_light(const std::array<Vec3, 3>& corners, const LightHull& hull) {
  Aabb light, box;
  for (const Vec3& c : hull.corners) light.grow(c);
  for (const Vec3& c : corners) box.grow(c);
  for (int a = 0; a < 3; ++a)
    if (box.min[a] > light.max[a] || box.max[a] < light.min[a]) return false;
  return true;
}

}  // namespace

SoftEdges::SoftEdges(const World& world, const raytrace::Topology& topology, const LightHull& hull,
                     double position_error) {
  std::vector<std::int8_t> side(world.triangle_count());
  std::vector<char> whole(world.triangle_count());
  parallel_for(world.triangle_count(), [&](std::uint32_t t) {
    const auto corners = world.corners(t);
    side[t] = static_cast<std::int8_t>(side_of_light(corners, hull, position_error));
    whole[t] = world.is_masked(t) || (side[t] == 0 && may_touch_light(corners, hull)) ? 1 : 0;
  });
  for (std::uint32_t t = 0; t < world.triangle_count(); ++t) {
    const auto corners = world.corners(t);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t across = topology.across(t, k);
      const bool shared =
          across != raytrace::Topology::boundary && across != raytrace::Topology::non_manifold;
      if (shared && side[t] != 0 && side[across] == side[t]) continue;
      if (shared && across < t) continue;  // the other triangle's turn
      const auto i = static_cast<std::size_t>(k);
      edges_.push_back({corners[i], corners[(i + 1) % 3]});
    }
  }
  for (std::uint32_t t = 0; t < world.triangle_count(); ++t) {
    if (whole[t] == 0) continue;
    const auto [a, b, c] = world.corners(t);
    const Vec3 middle = (a + b + c) / 3.0;
    const double radius =
        std::max({glm::length(a - middle), glm::length(b - middle), glm::length(c - middle)});
    edges_.push_back({middle, middle, (1.0 + 0x1p-40) * radius + position_error});
  }
  if (edges_.empty()) return;
  nodes_.reserve(edges_.size());
  build(0, static_cast<std::uint32_t>(edges_.size()));
}

std::uint32_t SoftEdges::build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Aabb box, middles;
  double most = 0.0;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Edge& e = edges_[i];
    box.grow(e.a), box.grow(e.b), middles.grow(0.5 * (e.a + e.b));
    most = std::max(most, e.radius);
  }
  nodes_.push_back({box.center(), (0.5 + 0x1p-40) * box.diagonal() + most, first, count, 0});
  if (count <= leaf_edges) return index;
  const Vec3 extent = middles.extent();
  int axis = extent.x >= extent.y ? 0 : 1;
  if (extent.z > extent[axis]) axis = 2;
  const auto begin = edges_.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [axis](const Edge& a, const Edge& b) {
    return a.a[axis] + a.b[axis] < b.a[axis] + b.b[axis];
  });
  build(first, half);
  const std::uint32_t second = build(first + half, count - half);
  nodes_[index].second = second;
  return index;
}

void SoftEdges::find(const LightCone& cone, std::vector<std::uint32_t>& found) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, 64> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Node& node = nodes_[index];
    if (!cone.may_intersect_ball(node.center, node.radius)) continue;
    if (node.second != 0) {
      stack[size++] = node.second, stack[size++] = index + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) found.push_back(i);
  }
}

LightCone::LightCone(const Vec3& point, double point_radius, const LightHull& hull)
    : point_(point), point_radius_(point_radius), light_radius_(hull.radius) {
  const Vec3 to_light = hull.center - point;
  length_ = glm::length(to_light);
  everything_ = !(length_ > light_radius_ + point_radius_);
  if (everything_) return;
  axis_ = to_light / length_;
  sine_ = (light_radius_ - point_radius_) / length_;
  cosine_ = std::sqrt((1.0 - sine_) * (1.0 + sine_));
}

bool LightCone::may_intersect_ball(const Vec3& center, double radius) const {
  if (everything_) return true;
  const Vec3 d = center - point_;
  const double along = glm::dot(d, axis_);
  if (along < -(point_radius_ + radius) || along > length_ + light_radius_ + radius) return false;
  return beside(glm::length(d - along * axis_), along) <= radius;
}

// beside() of a point of the segment is convex along it: its least value is at an end or where its slope
// vanishes.
bool LightCone::may_intersect_segment(const Vec3& a, const Vec3& b, double margin) const {
  if (everything_) return true;
  const Vec3 from = a - point_, step = b - a;
  const double along = glm::dot(from, axis_), along_step = glm::dot(step, axis_);
  // The part with -margin <= along <= length + radius + margin.
  double first = 0.0, last = 1.0;
  const double low = -(margin + point_radius_), high = length_ + light_radius_ + margin;
  if (along_step == 0.0) {
    if (along < low || along > high) return false;
  } else {
    const double t0 = (low - along) / along_step, t1 = (high - along) / along_step;
    first = std::max(first, std::min(t0, t1)), last = std::min(last, std::max(t0, t1));
    if (first > last) return false;
  }
  const Vec3 lateral = from - along * axis_, lateral_step = step - along_step * axis_;
  const auto value = [&](double t) {
    return beside(glm::length(lateral + t * lateral_step), along + t * along_step);
  };
  double least = std::min(value(first), value(last));
  const double speed = glm::length(lateral_step);
  if (speed > 0.0) {
    const double start = glm::dot(lateral, lateral_step) / speed;
    const double off = glm::length(lateral - (start / speed) * lateral_step);
    const double slope = sine_ * along_step / speed;
    const double square = cosine_ * cosine_ - slope * slope;
    if (square > 0.0) {
      const double t = (slope * off / std::sqrt(square) - start) / speed;
      if (t > first && t < last) least = std::min(least, value(t));
    }
  }
  return least <= margin;
}

}  // namespace gnomon::hybrid
