// Nodes of the hierarchy against the frustum (or column) of many rays: Reshetov, Soupikov, Hurley 2005,
// "Multi-level ray tracing algorithm", section 3.

#if defined(GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#endif

#include <hwy/highway.h>

#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Per packet the intervals of its rays.
struct alignas(64) Packets {
  float u_min[tile_packets], u_max[tile_packets], v_min[tile_packets], v_max[tile_packets];
  float far_min[tile_packets];  ///< +infinity: no ray of it asks any more
};

/// The rays' region as four planes and a depth; for each the box corner farthest along it is looked at.
class Frustum {
 public:
  static constexpr std::size_t sides = 4;

  Frustum(const Bvh& bvh, const EdgeSetup& setup, const Packets& packets) {
    const Vec3 origin = setup.origin - bvh.center;
    const double u_min = smallest(packets.u_min), u_max = largest(packets.u_max);
    const double v_min = smallest(packets.v_min), v_max = largest(packets.v_max);
    const Vec3 &u = setup.axes[0], &v = setup.axes[1], &depth = setup.axes[2];
    if (setup.directional) {
      set(0, u, -u_min - glm::dot(u, origin), setup), set(1, -u, u_max + glm::dot(u, origin), setup);
      set(2, v, -v_min - glm::dot(v, origin), setup), set(3, -v, v_max + glm::dot(v, origin), setup);
      set(4, depth, -glm::dot(depth, origin), setup);
    } else {
      const auto side = [&](std::size_t k, const Vec3& n) { set(k, n, -glm::dot(n, origin), setup); };
      side(0, u - u_min * depth), side(1, u_max * depth - u);
      side(2, v - v_min * depth), side(3, v_max * depth - v);
      side(4, -depth);
    }
  }

  /// Bit i: child i may be intersected by a ray at a priority of at least `limit` (priority:
  /// minus the depth of a point's boxes, the height of a direction's).
  unsigned hits(const BvhNode& node, float limit, float* priority) const {
    unsigned hit = 0;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
      auto least = along(node, 0, i);
      for (std::size_t k = 1; k < sides; ++k) least = hn::Min(least, along(node, k, i));
      const auto order = along(node, 4, i);
      hn::Store(order, four, priority + i);
      const auto keep = hn::And(hn::Ge(least, hn::Zero(four)), hn::Ge(order, hn::Set(four, limit)));
      hit |= mask_bits(four, keep) << i;
    }
    return hit;
  }

 private:
  void set(std::size_t k, const Vec3& n, double constant, const EdgeSetup& setup) {
    for (std::size_t a = 0; a < 3; ++a) {
      n_[k][a] = static_cast<float>(n[static_cast<int>(a)]);
      row_[k][a] = n_[k][a] > 0.0f ? 3 + a : a;
    }
    c_[k] = float_above(constant + 4.0 * setup.slack);
  }
  hn::Vec<Four> along(const BvhNode& node, std::size_t k, std::size_t i) const {
    auto sum = hn::Set(four, c_[k]);
    for (std::size_t a = 0; a < 3; ++a)
      sum = hn::MulAdd(hn::Set(four, n_[k][a]), hn::Load(four, node.bounds[row_[k][a]] + i), sum);
    return sum;
  }

  float n_[5][3] = {}, c_[5] = {};
  std::size_t row_[5][3] = {};
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
