// What can stand between a point and a light with size: where nothing can, no ray needs to be cast, and where little can, the
// rays ask for that alone.
#pragma once

#include <array>

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// Fewer rays cost less than to find out.
inline constexpr int least_shaft_rays = 8;

/// Makes what shafts are traced through, where so many rays are asked at a point. Without it shafts say nothing, until
/// other rays have had it made: call this before a pass, so that its count of rays cast does not depend on them.
void prepare_light_shafts(const Tracer& tracer, int rays);

/// All that the rays that LightSamples makes may intersect.
class LightBlockers {
 public:
  /// No ray intersects anything, and all go above the point's horizon.
  bool none() const { return known_ && count_ == 0 && !planes_; }
  /// Whether something blocks one of the rays.
  bool block(const Tracer& tracer, const Ray& ray) const {
    return known_ ? tracer.occluded_among(ray, {leaf_.data(), count_}) : tracer.occluded(ray);
  }

 private:
  friend LightBlockers find_light_blockers(const Tracer&, const SurfacePoint&, const Light&, int);
  /// Returns false where there are more than it pays to ask one by one.
  bool add(std::uint32_t leaf, bool placed);

  /// About as many as take a ray as long as all of the tree.
  static constexpr int most = 16;
  static constexpr int placed_price = 4;  ///< of a kept instance's leaf, in others
  std::array<std::uint32_t, most> leaf_{};
  std::size_t count_ = 0;
  int price_ = 0;
  bool known_ = false, planes_ = false;
};

/// For so many rays. Nothing is known where they are few, where there is no tree for shafts, or where too much is in the way.
LightBlockers find_light_blockers(const Tracer& tracer, const SurfacePoint& from, const Light& light,
                                  int rays);

}  // namespace gnomon::raytrace
