// One primitive against a vector of shadow rays (tile_state-inl.h). Along a ray, what the primitive's depth may be is an
// interval. Wholly behind the receiver it does not matter. Wholly before it and inside all edges it surely blocks.
// Between the two nobody knows.

#if defined(GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#endif

#include <hwy/highway.h>

#include "raytrace/packets/mask_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// What a primitive is to rays besides its numbers.
struct Blocker {
  std::uint32_t not_from;  ///< rays that leave this primitive are not blocked
  bool may_be_sure;
  const TriangleMask* mask = nullptr;  ///< if any is known
};

/// A vector of rays from `at` on; those whose `far`, the receivers' reciprocal depth or depth along the light, is infinite
/// are not asked. A flat primitive never blocks the rays that leave it (of others the double kernels know when). A plane's
/// edge functions are not looked at.
template <bool plane>
struct BlockedRays {
  V far, edge, depth;
  M known, perhaps;
  HWY_INLINE BlockedRays(const LaneNumbers& p, const Blocker& blocker, const TileRays& rays,
                         const float* far_of, std::size_t at)
      : far(hn::Load(f, far_of + at)) {
    const V u = hn::Load(f, rays.u + at), v = hn::Load(f, rays.v + at);
    edge = plane ? all(inf) : p.least_edge(u, v);
    depth = p.reciprocal_depth(u, v);
    known = hn::Gt(depth, p.depth_floor());
    const M behind = hn::And(hn::Lt(depth, hn::Sub(far, p.depth_error())), known);
    const M near = hn::AndNot(behind, hn::And(hn::Lt(far, all(inf)), hn::Ge(edge, hn::Neg(p.edge_error()))));
    const auto leaves = hn::Eq(hn::Load(ids, rays.source + at), hn::Set(ids, blocker.not_from));
    perhaps = hn::AndNot(hn::RebindMask(f, leaves), near);
  }
  M surely(const LaneNumbers& p) const {
    const M ahead = hn::And(hn::Gt(depth, hn::Add(far, p.depth_error())), known);
    return hn::And(perhaps, hn::And(hn::Gt(edge, p.edge_error()), ahead));
  }
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
