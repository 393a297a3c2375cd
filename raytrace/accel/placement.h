// A ray as the tree of a placed mesh sees it. The tree's boxes are in the mesh's own space, moved and scaled
// by a power of two so that they lie in the cube [-1, 1]^3. The triangles that are tested are the world's. A
// box may be passed over only when no point at which the world's arithmetic could find a hit lies in it. So
// the ray's origin enters as an interval that answers for every rounding between the two spaces.
//
// The bound. Let x = o + t d be where the world's test finds the hit, and q' the point of the tree's space
// that belongs to it. Let B = world_from_tree's linear part, N = tree_from_world, R = I - N B, and c the
// world's place of the tree's origin. World corners are B p' + c up to their rounding e, and c's own; the
// test itself is right up to E (backward). So B q' = x - c + f with |f| <= 2 e + E, hence
//   q' = N (x - c) + N f + R q' = N (o + t0 d - c) + (t - t0) N d + N f + R q'
// for any t0. The first two terms are computed; their rounding, N f and R q' make the interval. |q'| <= 1,
// and t d never reaches further than the mesh: |t d| <= |o - c| + half + E. (After the running error analysis
// of Higham 2002, section 3.3; t0 is chosen near the mesh, so that floats are fine enough there.)
#pragma once

#include <optional>

#include "raytrace/bvh/traverse.h"

namespace gnomon::raytrace {

/// tree = (object - center) * 2^-exponent.
struct MeshSpace {
  Vec3 center{0.0};
  int exponent = 0;
  Vec3 largest{0.0};  ///< of the corners' coordinates, in absolute value

  /// Makes the space of finite corners that are not all at one place.
  explicit MeshSpace(const Aabb& object_box);
  Vec3 tree_from_object(const Vec3& p) const;
};

struct Placement {
  Mat3 tree_from_world;  ///< the linear part, N
  Vec3 center;           ///< the tree's origin in the world, c
  Vec3 half;             ///< the mesh's corners are no further from it, along the world's axes
  Vec3 row_sum;          ///< of |N|
  Vec3 error;            ///< what does not depend on the ray, in the tree's space
};

/// None where no useful bound can be had: flattened, nearly so, not finite, of extreme size.
std::optional<Placement> place(const MeshSpace& space, const Mat4& world_from_object);

/// The ray in the tree's space, its parameter (t - begin) * scale.
struct PlacedRay {
  RayFrame frame{};
  Vec3 origin_error{0.0};
  double begin, scale;

  /// begin: t0 above, any number.
  PlacedRay(const Placement& placement, const BoxRay& ray, double begin);
  double parameter(float t) const { return (static_cast<double>(t) - begin) * scale; }
};

inline PlacedRay::PlacedRay(const Placement& placement, const BoxRay& ray, double t0) : begin(t0) {
  const RayFrame& world = *ray.frame;
  Vec3 origin, direction;
  double reach = 0.0;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    direction[a] = world.direction[i];
    const double offset = world.origin[i] - placement.center[a], advance = t0 * direction[a];
    origin[a] = offset + advance;
    reach = std::max(reach, std::abs(offset) + std::abs(advance) + placement.half[a]);
  }
  // In units of reach: 12 for the world's test and 3 for the difference and the advance. N times the origin
  // and N times the direction, which reaches up to twice as far, take 3 each. The rest is to spare.
  constexpr double roundings = error_gamma(64);
  origin = placement.tree_from_world * origin;
  direction = placement.tree_from_world * direction;
  int exponent = 0;
  std::frexp(max_component(glm::abs(direction)), &exponent);
  scale = std::ldexp(1.0, exponent);
  direction *= std::ldexp(1.0, -exponent);
  constexpr double flat = 0x1p-120;  // a direction's component too small for a float's inverse counts as zero
  origin_error = (roundings * reach + max_component(ray.origin_error)) * placement.row_sum + placement.error +
                 Vec3(flat * (1.0 + max_component(glm::abs(origin))));
  for (std::size_t i = 0; i < 3; ++i) {
    frame.origin[i] = origin[static_cast<int>(i)];
    frame.direction[i] = direction[static_cast<int>(i)];
  }
  frame.t = {parameter(ray.t_min), parameter(ray.t_max)};
}

}  // namespace gnomon::raytrace
