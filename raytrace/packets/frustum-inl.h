// A tile's traversal through the hierarchy. Boxes are culled against the tile's frustum (or column),
// triangles against the intervals of all 16 packets at once (Reshetov, Soupikov, Hurley 2005, "Multi-level
// ray tracing algorithm", section 3).

#if defined(GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_FRUSTUM_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
using Four = hn::CappedTag<float, 4>;
constexpr Four four;

/// Per packet the intervals of its rays.
struct alignas(64) Packets {
  float u_min[tile_packets], u_max[tile_packets], v_min[tile_packets], v_max[tile_packets];
  float far_min[tile_packets];  ///< +infinity: no ray of it asks any more
};

/// A lower bound u·d_u + v·d_v + constant of shadow rays' `far`: receivers on one plane lie on it exactly,
/// for reciprocal depth is linear there. So a surface's own triangles are told to be behind its receivers.
struct Floor {
  float u = 0.0f, v = 0.0f, constant = 0.0f;
};
struct alignas(64) Floors {
  float u[tile_packets], v[tile_packets], constant[tile_packets];
};

inline void gather_packets(const TileRays& rays, Packets& packets) {
  for (std::size_t p = 0; p < tile_packets; ++p) {
    V u_min = all(inf), u_max = all(-inf), v_min = all(inf), v_max = all(-inf);
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const M alive = mask_of(static_cast<unsigned>(rays.alive[p]) >> i);
      const V u = hn::Load(f, rays.u + p * packet_rays + i), v = hn::Load(f, rays.v + p * packet_rays + i);
      u_min = hn::Min(u_min, hn::IfThenElse(alive, u, u_min)),
      u_max = hn::Max(u_max, hn::IfThenElse(alive, u, u_max));
      v_min = hn::Min(v_min, hn::IfThenElse(alive, v, v_min)),
      v_max = hn::Max(v_max, hn::IfThenElse(alive, v, v_max));
    }
    packets.u_min[p] = hn::GetLane(hn::MinOfLanes(f, u_min)),
    packets.u_max[p] = hn::GetLane(hn::MaxOfLanes(f, u_max));
    packets.v_min[p] = hn::GetLane(hn::MinOfLanes(f, v_min)),
    packets.v_max[p] = hn::GetLane(hn::MaxOfLanes(f, v_max));
  }
}

/// The tile's region as four planes and a depth; for each the box corner farthest along it is looked at.
class Frustum {
 public:
  static constexpr std::size_t sides = 4;

  Frustum(const Bvh& bvh, const EdgeSetup& setup, const Axes& axes, const Packets& packets) {
    const Vec3 origin = setup.origin - bvh.center;
    const double u_min = smallest(packets.u_min), u_max = largest(packets.u_max);
    const double v_min = smallest(packets.v_min), v_max = largest(packets.v_max);
    const Vec3 u = setup.axes[axes.u], v = setup.axes[axes.v],
               depth = static_cast<double>(axes.sign) * setup.axes[axes.depth];
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

  /// Boxes wholly behind the floor are left out as well.
  void stand_on(const Floor& floor, const Bvh& bvh, const EdgeSetup& setup, const Axes& axes) {
    const Vec3 origin = setup.origin - bvh.center;
    const Vec3 u = setup.axes[axes.u], v = setup.axes[axes.v],
               depth = static_cast<double>(axes.sign) * setup.axes[axes.depth];
    const double gu = floor.u, gv = floor.v, gc = floor.constant;
    // Of a point: reciprocal depth 1 / z > g·(x / z, y / z, 1). Scaled so that the slack is in world units.
    Vec3 n = -(gu * u + gv * v + gc * depth);
    double constant = 1.0;
    if (setup.directional) n = depth - gu * u - gv * v, constant = -gc;
    const double length = glm::length(n);
    if (!(length > 1e-30 && length < 1e30)) return;
    set(5, n / length, (constant - glm::dot(n, origin)) / length, setup);
    planes_ = 6;
  }

  /// Bit i: child i may be intersected by a ray of the tile at a priority of at least `limit` (priority:
  /// minus the depth of a point's boxes, the height of a direction's).
  unsigned hits(const BvhNode& node, float limit, float* priority) const {
    unsigned hit = 0;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
      auto least = along(node, 0, i);
      for (std::size_t k = 1; k < sides; ++k) least = hn::Min(least, along(node, k, i));
      if (planes_ == 6) least = hn::Min(least, along(node, 5, i));
      const auto order = along(node, 4, i);
      hn::Store(order, four, priority + i);
      const auto keep = hn::And(hn::Ge(least, hn::Zero(four)), hn::Ge(order, hn::Set(four, limit)));
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(four, keep, bytes);
      hit |= static_cast<unsigned>(bytes[0]) << i;
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

  float n_[6][3] = {}, c_[6] = {};
  std::size_t row_[6][3] = {};
  std::size_t planes_ = 5;
};

/// Visits the leaves that the tile may intersect, highest priority first: leaf(first, count) returns false to
/// end the traversal; limit() is the least priority still of interest; ahead(child) is told what will come.
template <class Leaf, class Limit, class Ahead>
void traverse_tile(const Bvh& bvh, const Frustum& frustum, const Limit& limit, const Leaf& leaf,
                   const Ahead& ahead) {
  struct Entry {
    BvhChild child;
    float priority;
  };
  Entry stack[Bvh::stack_size];
  std::size_t size = 0;
  stack[size++] = {BvhChild::node(0), inf};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.priority < limit()) continue;
    if (entry.child.is_leaf()) {
      if (!leaf(entry.child.first(), entry.child.count())) return;
      continue;
    }
    const BvhNode& node = bvh.nodes[entry.child.index()];
    alignas(16) float priority[4];
    const std::size_t base = size;
    for (unsigned mask = frustum.hits(node, limit(), priority); mask != 0; mask &= mask - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(mask));
      std::size_t at = size++;
      for (; at > base && stack[at - 1].priority > priority[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[i], priority[i]};
      ahead(node.child[i]);
    }
  }
}

template <class Leaf, class Limit>
void traverse_tile(const Bvh& bvh, const Frustum& frustum, const Limit& limit, const Leaf& leaf) {
  traverse_tile(bvh, frustum, limit, leaf, [](BvhChild) {});
}

/// Bit p: packet p may intersect the primitive in front of what it knows already.
template <class Behind>
unsigned intersected_packets(const PrimitiveEdges& p, const Functions& of, const Packets& packets,
                             const Behind& behind) {
  const auto most = [&](const Linear& l, std::size_t i) {
    const float* u = l.u > 0.0f ? packets.u_max : packets.u_min;
    const float* v = l.v > 0.0f ? packets.v_max : packets.v_min;
    return value(all(l.u), all(l.v), all(l.constant), hn::Load(f, u + i), hn::Load(f, v + i));
  };
  const bool by_depth = !(p.depth_floor > -1e30f);
  unsigned hit = 0;
  for (std::size_t i = 0; i < tile_packets; i += lanes()) {
    const V edges = hn::Min(most(of.edge[0], i), hn::Min(most(of.edge[1], i), most(of.edge[2], i)));
    const V far = hn::Load(f, packets.far_min + i);
    M keep = hn::And(hn::Ge(edges, all(-p.edge_error)), hn::Lt(far, all(inf)));
    if (by_depth) {
      const V depth_error = all(p.depth_error);
      keep = hn::AndNot(hn::Lt(most(of.reciprocal_depth, i), hn::Sub(far, depth_error)), keep);
      keep = hn::AndNot(behind(of.reciprocal_depth, depth_error, i), keep);
    }
    hit |= bits_of(keep) << i;
  }
  return hit;
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
