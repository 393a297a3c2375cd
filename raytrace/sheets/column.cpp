#include "raytrace/sheets/column.h"

#include <algorithm>

namespace gnomon::raytrace {
namespace {

constexpr double vertex_gamma =
    error_gamma(32);  // of a coordinate, of a receiver on it, and of the light's frame
constexpr double product_gamma = error_gamma(16);

double sum_of_magnitudes(const Vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace

TexelColumn::TexelColumn(const LightView& view, int face, int column, int row)
    : perspective_(view.projection == LightProjection::perspective),
      face_(view.faces[static_cast<std::size_t>(face)]),
      origin_(view.origin),
      origin_size_(sum_of_magnitudes(view.origin) + std::abs(face_.center.x) + std::abs(face_.center.y)) {
  const auto edge = [&](int i, double half) { return (2.0 * i / view.size - 1.0) * half; };
  x_ = {edge(column, face_.half_extent.x), edge(column + 1, face_.half_extent.x)};
  y_ = {edge(row, face_.half_extent.y), edge(row + 1, face_.half_extent.y)};
  reach_ = std::max({std::abs(x_[0]), std::abs(x_[1]), std::abs(y_[0]), std::abs(y_[1])});
  grid_error_ = product_gamma * std::max(face_.half_extent.x, face_.half_extent.y);
  handedness_ = glm::dot(glm::cross(face_.right, face_.up), face_.forward) < 0.0 ? -1.0 : 1.0;
  corners_ = {Vec3(x_[0], y_[0], 1.0), Vec3(x_[1], y_[0], 1.0), Vec3(x_[1], y_[1], 1.0),
              Vec3(x_[0], y_[1], 1.0)};
}

Vec3 TexelColumn::homogeneous(const Vec3& q) const {
  if (perspective_) return q;
  const double x = q.x - face_.center.x, y = q.y - face_.center.y, b = face_.half_extent.y;
  return {x, y + face_.warp * b * b, 1.0 + face_.warp * y};
}

LightVertex TexelColumn::vertex(const Vec3& world) const {
  const Vec3 d = world - origin_;
  const Vec3 q(glm::dot(face_.right, d), glm::dot(face_.up, d), glm::dot(face_.forward, d));
  const double error = vertex_gamma * (sum_of_magnitudes(world) + origin_size_);
  if (face_.warp == 0.0) return {q, homogeneous(q), error};
  const Vec3 h = homogeneous(q);
  const double b = face_.half_extent.y;
  return {q, h, std::max(1.0, face_.warp) * error + vertex_gamma * (sum_of_magnitudes(h) + b)};
}

bool TexelColumn::surely_outside(std::span<const LightVertex> vertices) const {
  // Most planes have the first vertex inside.
  const auto all = [&](const auto& is_outside) {
    return std::all_of(vertices.begin(), vertices.end(), is_outside);
  };
  for (std::size_t plane = 0; plane < 4; ++plane)
    if (all([&](const LightVertex& v) { return side_value(v.h, plane) < -plane_error(v); })) return true;
  return (perspective_ || face_.warp != 0.0) && all([](const LightVertex& v) { return v.h.z < -v.error; });
}

int TexelColumn::side_of_corners(const LightVertex& a, const LightVertex& b) const {
  const Vec3 n = glm::cross(a.h, b.h);
  const double size_a = max_component(glm::abs(a.h)), size_b = max_component(glm::abs(b.h));
  const double size_c = std::max(1.0, reach_);
  // A 3 x 3 determinant has six products of one component each (of a, b and a corner).
  const double error = 6.0 * (size_c * (a.error * (size_b + b.error) + b.error * size_a) +
                              (grid_error_ + product_gamma * size_c) * size_a * size_b);
  bool all_above = true, all_below = true;
  for (const Vec3& corner : corners_) {
    const double side = glm::dot(n, corner);
    all_above = all_above && side > error;
    all_below = all_below && side < -error;
  }
  return all_above ? 1 : all_below ? -1 : 0;
}

bool TexelColumn::surely_misses(const LightVertex& a, const LightVertex& b) const {
  const std::array<LightVertex, 2> segment{a, b};
  return surely_outside(segment) || side_of_corners(a, b) != 0;
}

bool TexelColumn::surely_misses(const std::array<LightVertex, 3>& triangle) const {
  if (surely_outside(triangle)) return true;
  const int facing_light = facing(triangle);
  if (facing_light == 0) return false;
  // The projected winding: a triangle that faces the light has its normal against forward.
  const int inside = facing_light * (handedness_ > 0.0 ? -1 : 1);
  for (std::size_t k = 0; k < 3; ++k)
    if (side_of_corners(triangle[k], triangle[(k + 1) % 3]) == -inside) return true;
  return false;
}

int TexelColumn::facing(const std::array<LightVertex, 3>& t) const {
  const Vec3 e1 = t[1].q - t[0].q, e2 = t[2].q - t[0].q;
  const Vec3 n = glm::cross(e1, e2);
  const double error = t[0].error + t[1].error + t[2].error;
  const double s1 = max_component(glm::abs(e1)), s2 = max_component(glm::abs(e2));
  // n . ray, with the ray through the first corner; n is off by n_error in each component.
  const double n_error = 2.0 * (error * (s1 + s2 + error) + product_gamma * s1 * s2);
  const Vec3 ray = perspective_ ? t[0].q : Vec3(0.0, 0.0, 1.0);
  const double value = glm::dot(n, ray);
  const double ray_size = sum_of_magnitudes(ray);
  const double bound = n_error * ray_size + (perspective_ ? error * sum_of_magnitudes(n) : 0.0) +
                       product_gamma * glm::dot(glm::abs(n), glm::abs(ray));
  if (std::abs(value) <= bound || !std::isfinite(value)) return 0;
  // A mirrored frame turns the cross product round.
  return (value < 0.0) == (handedness_ > 0.0) ? 1 : -1;
}

}  // namespace gnomon::raytrace
