// Rays that are aimed where arithmetic fails: at corners, at points of edges, at centroids and whole numbers,
// nudged by 0 ... 4 representable numbers.
#pragma once

#include "verify/rational.h"
#include "verify/small_world.h"

namespace gnomon::verify {

struct AimedTriangle {
  std::array<Vec3, 3> corners;
  Vec3 origin, direction;
};
/// Coordinates of sizes from 1e-8 to 1e8, of either sign, any axis along any other.
AimedTriangle aimed_triangle(Random& random);
/// Whether the tracer's own test of a single triangle says that the ray meets it.
bool kernel_meets(raytrace::Precision precision, const AimedTriangle& aimed);
/// By how many roundings of its coordinates (doubles) the line passes the edge in question.
double roundings_from_edge(const AimedTriangle& aimed, const RationalTriangle& truth);
/// What `robust` may take for either side of an edge: it promises closed meshes, not exact triangles.
inline constexpr double roundings_of_an_edge = 64.0;

/// A closed mesh over a floor, lit from a corner; shadow rays from the floor through corners and edges.
class AdversarialShadows {
 public:
  explicit AdversarialShadows(std::uint64_t seed);
  const World& world() const { return world_.world(); }
  const Light& light() const { return light_; }
  /// A receiver on the floor, as Precision::robust finds it; nothing now and then.
  std::optional<raytrace::SurfacePoint> receiver(Random& random) const;
  bool shadowed(const raytrace::SurfacePoint& point) const;  ///< by rational numbers

 private:
  SmallWorld world_;
  raytrace::Tracer finder_;
  Light light_;
};

}  // namespace gnomon::verify
