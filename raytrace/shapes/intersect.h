// Rays against triangles and spheres, in double precision.
//
// Triangles: Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection", JCGT 2(1). The corners are
// moved to the ray's origin and sheared so that the ray is the z axis; what remains is whether the 2D origin
// lies in a triangle. A corner is rounded the same way for every triangle that shares it. The sign of each
// edge function is exact for the rounded corners. Rounding is monotone, so a difference of two rounded
// products has the right sign or is zero. Zero is decided by the products' exact residuals. Hence closed sets
// of triangles have no holes. A point exactly on an edge belongs to both triangles. (Products below 1e-292
// underflow: scenes smaller than 1e-146 are out of scope.)
//
// Spheres: Haines et al. 2019, "Precision improvements for ray/sphere intersection", Ray Tracing Gems,
// chapter 7.
#pragma once

#include <bit>
#include <cstddef>
#include <optional>

#include "raytrace/bvh/bvh.h"
#include "scene/math.h"

namespace gnomon::raytrace {

/// A ray made ready: its direction scaled by a power of two so that the largest component lies in [1/2, 1).
/// Every t inside the kernels is in multiples of the scaled direction.
struct RayFrame {
  std::array<double, 3> origin, direction;
  std::size_t kx, ky, kz;  ///< kz: the axis of the largest component
  double shear_x, shear_y, shear_z;
  double kernel_t_from_t;  ///< a power of two
  Interval t;              ///< hits count in the open interval (t.min, t.max)
};

/// A scaled frame's direction and scale where a power of two or its inverse is no normal number.
[[gnu::noinline, gnu::cold]] inline void scale_extreme(const Ray& ray, double largest, RayFrame& frame) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  frame.kernel_t_from_t = std::ldexp(1.0, std::min(exponent, 1023));
  for (std::size_t a = 0; a < 3; ++a)
    frame.direction[a] = std::ldexp(ray.direction[static_cast<int>(a)], -exponent);
}

/// Fills origin, direction, t and their scale. False for a ray that cannot hit: NaN or infinite origin or
/// direction, direction zero, interval empty or NaN.
inline bool scale_ray(const Ray& ray, RayFrame& frame) {
  if (!all_finite(ray.origin) || !all_finite(ray.direction)) return false;
  const Vec3& d = ray.direction;
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (!(largest > 0.0) || !(ray.t.min <= ray.t.max)) return false;
  constexpr int exponent_bits = 52, bias = 1023;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> exponent_bits) - (bias - 1);
  if (exponent > 1 - bias && exponent < bias) [[likely]] {
    const auto power = [](int e) {
      return std::bit_cast<double>(static_cast<std::uint64_t>(bias + e) << exponent_bits);
    };
    const double scale = power(-exponent);
    frame.kernel_t_from_t = power(exponent), frame.direction = {d.x * scale, d.y * scale, d.z * scale};
  } else {
    scale_extreme(ray, largest, frame);
  }
  frame.t = {ray.t.min * frame.kernel_t_from_t, ray.t.max * frame.kernel_t_from_t};
  frame.origin = {ray.origin.x, ray.origin.y, ray.origin.z};
  return true;
}

/// The rest of a scaled frame.
inline void shear_ray(RayFrame& frame) {
  const auto& d = frame.direction;
  frame.kz = std::abs(d[0]) >= std::abs(d[1]) ? 0 : 1;
  if (std::abs(d[2]) > std::abs(d[frame.kz])) frame.kz = 2;
  frame.kx = frame.kz == 2 ? 0 : frame.kz + 1;
  frame.ky = frame.kx == 2 ? 0 : frame.kx + 1;
  frame.shear_x = d[frame.kx] / d[frame.kz];
  frame.shear_y = d[frame.ky] / d[frame.kz];
  frame.shear_z = 1.0 / d[frame.kz];
}

inline std::optional<RayFrame> make_ray_frame(const Ray& ray) {
  RayFrame frame;
  if (!scale_ray(ray, frame)) return std::nullopt;
  shear_ray(frame);
  return frame;
}

/// a b - c d where the rounded products are equal: the exact residuals decide.
[[gnu::noinline, gnu::cold]] inline double residual_difference(double a, double b, double c, double d) {
  return std::fma(a, b, -(a * b)) - std::fma(c, d, -(c * d));
}

/// a b - c d with the right sign, zero only when it is zero.
inline double signed_difference(double a, double b, double c, double d) {
  const double difference = a * b - c * d;
  return difference != 0.0 ? difference : residual_difference(a, b, c, d);
}

/// A triangle in the ray's sheared frame, and the edge functions opposite to its corners.
struct ShearedTriangle {
  std::array<double, 3> x, y, z;
  double u, v, w;
};

inline ShearedTriangle shear(const RayFrame& ray, const LeafPrimitive& triangle) {
  ShearedTriangle s;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* corner = triangle.v.data() + 3 * i;
    const double depth = corner[ray.kz] - ray.origin[ray.kz];
    s.x[i] = (corner[ray.kx] - ray.origin[ray.kx]) - ray.shear_x * depth;
    s.y[i] = (corner[ray.ky] - ray.origin[ray.ky]) - ray.shear_y * depth;
    s.z[i] = depth;
  }
  s.u = signed_difference(s.x[2], s.y[1], s.y[2], s.x[1]);
  s.v = signed_difference(s.x[0], s.y[2], s.y[0], s.x[2]);
  s.w = signed_difference(s.x[1], s.y[0], s.y[1], s.x[0]);
  return s;
}

struct TriangleHit {
  double t, b1, b2;
};

/// Depth along kz at which the ray intersects the plane of a triangle that is much longer than wide; `z`, the
/// mean of the corners' depths, for any other. The mean's weights are known to rounding of the length squared
/// over twice the area. So depths of a triangle of length L and width W are off by L^2 / W roundings. The
/// plane's equation loses no more than L roundings if the normal is made from the two shorter edges.
inline double depth_in_plane(const RayFrame& ray, const LeafPrimitive& triangle, double z) {
  constexpr double stretched = 16.0;  // length over width from which the plane is better in any position
  const auto& v = triangle.v;
  const auto corner = [&](std::size_t i) { return Vec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]); };
  const std::array<Vec3, 3> c{corner(0), corner(1), corner(2)};
  const std::array<Vec3, 3> edge{c[2] - c[1], c[0] - c[2], c[1] - c[0]};  // opposite to each corner
  std::array<double, 3> squared;
  for (std::size_t i = 0; i < 3; ++i) squared[i] = glm::dot(edge[i], edge[i]);
  std::size_t k = squared[0] >= squared[1] ? 0 : 1;
  if (squared[2] > squared[k]) k = 2;
  const Vec3 n = glm::cross(edge[(k + 1) % 3], edge[(k + 2) % 3]);
  if (!(squared[k] * squared[k] > stretched * stretched * glm::dot(n, n))) return z;
  const Vec3 origin(ray.origin[0], ray.origin[1], ray.origin[2]);
  const Vec3 direction(ray.direction[0], ray.direction[1], ray.direction[2]);
  const double depth = glm::dot(n, c[k] - origin) / glm::dot(n, direction) * ray.direction[ray.kz];
  return std::isfinite(depth) ? depth : z;
}

/// The hit of a triangle whose edge functions agree. Its depth lies between the corners' however thin the
/// triangle; an edge-on triangle (det = 0) is a miss.
inline bool finish_triangle(const RayFrame& ray, const LeafPrimitive& triangle, const ShearedTriangle& s,
                            TriangleHit& hit) {
  const double det = s.u + s.v + s.w;
  if (!(det != 0.0)) return false;
  const double z = depth_in_plane(ray, triangle, (s.u * s.z[0] + s.v * s.z[1] + s.w * s.z[2]) / det);
  const double z_min = std::min({s.z[0], s.z[1], s.z[2]}), z_max = std::max({s.z[0], s.z[1], s.z[2]});
  hit = {std::clamp(z, z_min, z_max) * ray.shear_z, s.v / det, s.w / det};
  return true;
}

/// Whether the ray, which intersects the triangle's plane, does so after its origin: exact (precision/exact.cpp).
[[gnu::cold]] bool starts_before(const RayFrame& ray, const LeafPrimitive& triangle);

/// The t of a triangle that is as good as edge-on: where the ray intersects the plane, exact, moved to where it passes over
/// the triangle. False where the ray lies in the plane, or beside the triangle (precision/exact.cpp).
[[gnu::cold]] bool finish_edge_on(const RayFrame& ray, const LeafPrimitive& triangle, TriangleHit& hit);

/// Whether the edge functions' sum may be little more than the rounding of a sheared triangle that reaches so far along
/// the ray. A sheared coordinate has six roundings of at most width + depth. So the sum is known to 2^-46 of width
/// (width + depth), the width being that of the coordinates' largest. At some ten times that the weights are known to a
/// tenth.
inline bool is_edge_on(const ShearedTriangle& s, double depth) {
  const double across = std::abs(s.x[0]) + std::abs(s.x[1]) + std::abs(s.x[2]);
  const double up = std::abs(s.y[0]) + std::abs(s.y[1]) + std::abs(s.y[2]), width = across + up;
  return std::abs(s.u + s.v + s.w) < 0x1p-43 * width * (width + depth);
}

/// An origin in the triangle's own plane is no hit, such as that of an eye that is level with a floor. Yet the rounded t
/// may be above 0 by some roundings of the corners' distances.
inline bool intersect_triangle(const RayFrame& ray, const LeafPrimitive& triangle, TriangleHit& hit) {
  const ShearedTriangle s = shear(ray, triangle);
  if ((s.u < 0.0 || s.v < 0.0 || s.w < 0.0) && (s.u > 0.0 || s.v > 0.0 || s.w > 0.0)) return false;
  if (!finish_triangle(ray, triangle, s, hit)) return false;
  const double depth = std::max({std::abs(s.z[0]), std::abs(s.z[1]), std::abs(s.z[2])});
  if (is_edge_on(s, depth) && !finish_edge_on(ray, triangle, hit)) [[unlikely]]
    return false;
  if (!(hit.t > ray.t.min && hit.t < ray.t.max)) return false;
  const double reach = depth * std::abs(ray.shear_z);
  const bool is_rounding = ray.t.min == 0.0 && hit.t < 0x1p-49 * reach;
  return !is_rounding || starts_before(ray, triangle);
}

/// |offset|^2 - r^2 with the squares' residuals added: exact to the last place where it nearly vanishes.
[[gnu::noinline, gnu::cold]] inline double power_near_sphere(const Vec3& offset, double radius) {
  double sum = 0.0, rest = 0.0;
  const auto add = [&](double value) {  // two-sum, Knuth 1998
    const double next = sum + value;
    const double part = next - sum;
    rest += (sum - (next - part)) + (value - part);
    sum = next;
  };
  for (const double v : {offset.x, offset.y, offset.z}) add(v * v), add(std::fma(v, v, -(v * v)));
  add(-(radius * radius)), add(-std::fma(radius, radius, -(radius * radius)));
  return sum + rest;
}

/// The two roots in ascending order, or nothing. Equal roots: a tangent.
struct SphereRoots {
  double near, far;
};

inline bool sphere_roots(const RayFrame& ray, const Vec3& center, double radius, SphereRoots& roots) {
  const Vec3 d(ray.direction[0], ray.direction[1], ray.direction[2]);
  const Vec3 offset = Vec3(ray.origin[0], ray.origin[1], ray.origin[2]) - center;
  const double a = glm::dot(d, d);
  const double b = -glm::dot(offset, d);
  const Vec3 closest = offset + (b / a) * d;
  const double discriminant = radius * radius - glm::dot(closest, closest);
  if (!(discriminant >= 0.0)) return false;
  double power = glm::dot(offset, offset) - radius * radius;
  if (std::abs(power) < 0x1p-10 * radius * radius) power = power_near_sphere(offset, radius);
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  const double other = q != 0.0 ? power / q : 0.0;
  roots = {std::min(other, q / a), std::max(other, q / a)};
  return true;
}

/// The first root in the interval.
inline bool intersect_sphere(const RayFrame& ray, const LeafPrimitive& sphere, double& t) {
  SphereRoots roots;
  if (!sphere_roots(ray, Vec3(sphere.v[0], sphere.v[1], sphere.v[2]), sphere.v[3], roots)) return false;
  const auto inside = [&](double root) { return root > ray.t.min && root < ray.t.max; };
  if (!inside(roots.near) && !inside(roots.far)) return false;
  t = inside(roots.near) ? roots.near : roots.far;
  return true;
}

/// A ray along the plane misses it: 0/0 is NaN and n/0 infinite, and neither lies before t.max.
inline bool intersect_plane(const RayFrame& ray, const Plane& plane, double& t) {
  double height = 0.0, slope = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double n = plane.normal[static_cast<int>(a)];
    height += n * (plane.point[static_cast<int>(a)] - ray.origin[a]);
    slope += n * ray.direction[a];
  }
  t = height / slope;
  return std::isfinite(t) && t > ray.t.min && t < ray.t.max;
}

}  // namespace gnomon::raytrace
