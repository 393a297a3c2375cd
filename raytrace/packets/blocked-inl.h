// One primitive against a vector of shadow rays (tile_state-inl.h). Along a ray, what the primitive's depth may be is an
// interval: wholly behind the receiver it does not matter, wholly before it and inside all edges it surely blocks, and
// between the two nobody knows.

#if defined(GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_BLOCKED_INL_H_
#endif

#include <hwy/highway.h>

#include "raytrace/packets/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Rays that the primitive may block, and those among them that it surely does.
struct Blocked {
  M perhaps, surely;
};

/// `far`: the receivers' reciprocal depth, or depth along the light; `source`: the primitives that the rays
/// leave, of which a flat one never blocks them (of others the double kernels know when). `asked`: none else
/// may be blocked. A plane's edge functions are not looked at.
template <bool plane>
HWY_INLINE Blocked blocked_by(const PrimitiveEdges& p, const RayTest& test, V u, V v, V far,
                              hn::Vec<I> source, M asked) {
  const V edge = plane ? all(inf) : test.least_edge(u, v);
  const V edge_error = all(p.edge_error), depth_error = all(p.depth_error);
  const V reciprocal_depth = test.reciprocal_depth(u, v);
  const M known = hn::Gt(reciprocal_depth, all(p.depth_floor));
  const M behind = hn::And(hn::Lt(reciprocal_depth, hn::Sub(far, depth_error)), known);
  const M near = hn::AndNot(behind, hn::And(asked, hn::Ge(edge, hn::Neg(edge_error))));
  const std::uint32_t not_by = p.edge_error < inf ? p.id & ~never_sure : no_id;
  const M perhaps = hn::AndNot(hn::RebindMask(f, hn::Eq(source, hn::Set(ids, not_by))), near);
  if ((p.id & never_sure) != 0) return {perhaps, hn::Lt(far, far)};
  const M ahead = hn::And(hn::Gt(reciprocal_depth, hn::Add(far, depth_error)), known);
  return {perhaps, hn::And(perhaps, hn::And(hn::Gt(edge, edge_error), ahead))};
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
