#include "raytrace/accel/placement.h"

namespace gnomon::raytrace {
namespace {

constexpr double largest_size = 0x1p400;  // of a mesh in the world; beyond, and below the inverse, no sharing
constexpr double largest_residual = 0x1p-10;  // of N B against the identity: a thousandth of the mesh

Mat3 scaled(const Mat3& m, int exponent) {
  Mat3 out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[c][r] = std::ldexp(m[c][r], exponent);
  return out;
}

Mat3 absolute(const Mat3& m) {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

double largest_entry(const Mat3& m) {
  return std::max(
      {max_component(glm::abs(m[0])), max_component(glm::abs(m[1])), max_component(glm::abs(m[2]))});
}

bool all_entries_finite(const Mat3& m) {
  return all_finite(m[0]) && all_finite(m[1]) && all_finite(m[2]);
}

/// An inverse, near enough; its error is found afterwards. By way of entries near one: determinants of tiny
/// matrices underflow.
Mat3 near_inverse(const Mat3& m) {
  int exponent = 0;
  std::frexp(largest_entry(m), &exponent);
  return scaled(glm::inverse(scaled(m, -exponent)), -exponent);
}

/// Row sums of a bound on |I - N B|.
Vec3 residual(const Mat3& n, const Mat3& b) {
  const Mat3 product = n * b, sizes = absolute(n) * absolute(b);
  Vec3 sum(0.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      const double one = r == c ? 1.0 : 0.0;
      sum[r] += std::abs(one - product[c][r]) + error_gamma(8) * (one + sizes[c][r]);
    }
  return sum;
}

}  // namespace

MeshSpace::MeshSpace(const Aabb& box)
    : center(box.center()), largest(glm::max(glm::abs(box.min), glm::abs(box.max))) {
  const double half = max_component(glm::max(box.max - center, center - box.min));
  std::frexp(half, &exponent);
}

Vec3 MeshSpace::tree_from_object(const Vec3& p) const {
  const Vec3 offset = p - center;
  return {std::ldexp(offset.x, -exponent), std::ldexp(offset.y, -exponent), std::ldexp(offset.z, -exponent)};
}

std::optional<Placement> place(const MeshSpace& space, const Mat4& world_from_object) {
  const Mat3 linear(world_from_object);
  const Mat3 world_from_tree = scaled(linear, space.exponent);
  const double size = largest_entry(world_from_tree);
  if (!all_entries_finite(world_from_tree) || !(size < largest_size && size > 1.0 / largest_size))
    return std::nullopt;
  if (scaled(world_from_tree, -space.exponent) != linear) return std::nullopt;  // entries lost to underflow
  Placement p{};
  p.tree_from_world = near_inverse(world_from_tree);
  if (!all_entries_finite(p.tree_from_world)) return std::nullopt;
  const Vec3 rest = residual(p.tree_from_world, world_from_tree);
  if (!(max_component(rest) < largest_residual)) return std::nullopt;  // NaN too
  p.center = Vec3(world_from_object * Vec4(space.center, 1.0));
  if (!all_finite(p.center)) return std::nullopt;
  // The world's corners have four roundings each (scene/world.cpp), and so has the centre.
  const Vec3 rounding =
      2.0 * error_gamma(8) * (absolute(linear) * space.largest + glm::abs(Vec3(world_from_object[3])));
  constexpr double spare = 1.0 + 0x1p-20;  // for the roundings in this function
  p.half = spare * (absolute(world_from_tree) * Vec3(1.0) + rounding);
  p.row_sum = spare * (absolute(p.tree_from_world) * Vec3(1.0));
  p.error = spare * (absolute(p.tree_from_world) * rounding + rest);
  return p;
}

}  // namespace gnomon::raytrace
