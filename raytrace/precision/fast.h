// The textbook's arithmetic: floats throughout, Moeller and Trumbore 1997 for triangles, the naive quadratic
// for spheres, and an epsilon instead of error bounds. Other solids are hit in doubles here too. It is here
// to be compared with: HARD_CASES tells where each of these fails.
#pragma once

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// The textbook's fixed start of rays that leave a surface, world units.
inline constexpr double textbook_epsilon = 1e-4;

inline FastPrimitive fast_primitive(const LeafPrimitive& p, bool is_triangle) {
  FastPrimitive f;
  for (std::size_t i = 0; i < 9; ++i) f.v[i] = static_cast<float>(p.v[i]);
  if (is_triangle)
    for (std::size_t i = 3; i < 9; ++i) f.v[i] -= f.v[i % 3];  // edges from the first corner
  return f;
}

/// Kernel policy. The direction keeps its length, as textbooks have it.
class FastArithmetic {
 public:
  FastArithmetic(const Structures&, const RayFrame& ray) : scale_(ray.kernel_t_from_t) {
    for (std::size_t a = 0; a < 3; ++a) {
      origin_[static_cast<int>(a)] = static_cast<float>(ray.origin[a]);
      direction_[static_cast<int>(a)] = static_cast<float>(ray.direction[a] * scale_);
    }
  }

  bool leaf(const Structures& s, const RayFrame& ray, std::uint32_t index, Hit& hit) const {
    hit.primitive = s.bvh.id_at(index);
    if (index >= s.fast.size()) [[unlikely]]  // an instance's triangle
      return triangle(fast_primitive(leaf_at(s, index), true), ray, hit);
    const FastPrimitive& p = s.fast[index];
    if (s.has_shapes && !s.world->is_triangle(hit.primitive))
      return is_solid(s.world->shape(hit.primitive).geometry) ? intersect_leaf(s, ray, index, hit)
                                                              : sphere(p, ray, hit);
    return triangle(p, ray, hit);
  }

  bool plane(const Structures& s, const RayFrame& ray, std::uint32_t id, Hit& hit) const {
    const auto& p = std::get<Plane>(s.world->shape(id).geometry);
    hit.primitive = id;
    hit.barycentric = Vec2(0.0);
    const Vec3f n(p.normal);
    return accept(glm::dot(n, Vec3f(p.point) - origin_) / glm::dot(n, direction_), ray, hit);
  }

 private:
  bool accept(float t, const RayFrame& ray, Hit& hit) const {
    hit.t = static_cast<double>(t) * scale_;
    return hit.t > ray.t.min && hit.t < ray.t.max;
  }

  bool triangle(const FastPrimitive& triangle, const RayFrame& ray, Hit& hit) const {
    const auto& v = triangle.v;
    const Vec3f edge1(v[3], v[4], v[5]), edge2(v[6], v[7], v[8]);
    const Vec3f p = glm::cross(direction_, edge2);
    const float det = glm::dot(edge1, p);
    if (det == 0.0f) return false;
    const float inverse = 1.0f / det;
    const Vec3f s = origin_ - Vec3f(v[0], v[1], v[2]);
    const float u = glm::dot(s, p) * inverse;
    if (u < 0.0f || u > 1.0f) return false;
    const Vec3f q = glm::cross(s, edge1);
    const float w = glm::dot(direction_, q) * inverse;
    if (w < 0.0f || u + w > 1.0f) return false;
    hit.barycentric = Vec2(u, w);
    return accept(glm::dot(edge2, q) * inverse, ray, hit);
  }

  bool sphere(const FastPrimitive& sphere, const RayFrame& ray, Hit& hit) const {
    hit.barycentric = Vec2(0.0);
    const Vec3f offset = origin_ - Vec3f(sphere.v[0], sphere.v[1], sphere.v[2]);
    const float a = glm::dot(direction_, direction_), b = 2.0f * glm::dot(direction_, offset);
    const float c = glm::dot(offset, offset) - sphere.v[3] * sphere.v[3];
    const float discriminant = b * b - 4.0f * a * c;
    if (discriminant < 0.0f) return false;
    const float root = std::sqrt(discriminant);
    return accept((-b - root) / (2.0f * a), ray, hit) || accept((-b + root) / (2.0f * a), ray, hit);
  }

  Vec3f origin_, direction_;
  double scale_;
};

}  // namespace gnomon::raytrace
