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

/// Rays of a packet that the primitive may block, and those among them that it surely does.
struct Blocked {
  unsigned perhaps = 0, surely = 0;
};

/// What a primitive is to rays besides its numbers.
struct Blocker {
  std::uint32_t not_from;  ///< rays that leave this primitive are not blocked
  bool may_be_sure;
};

/// A packet's rays from `at` on; those whose `far`, the receivers' reciprocal depth or depth along the light, is infinite
/// are not asked. A flat primitive never blocks the rays that leave it (of others the double kernels know when). A plane's
/// edge functions are not looked at.
template <bool plane>
HWY_INLINE Blocked blocked_by(const LaneNumbers& p, const Blocker& blocker, const TileRays& rays,
                              const float* far_of, std::size_t at) {
  const auto u = [&](std::size_t k) { return hn::Load(f, rays.u + at + k * lanes()); };
  const auto v = [&](std::size_t k) { return hn::Load(f, rays.v + at + k * lanes()); };
  const auto far = [&](std::size_t k) { return hn::Load(f, far_of + at + k * lanes()); };
  const auto each = [](const auto& step) {
    for (std::size_t k = 0; k < packet_steps; ++k) step(k);
  };
  V edge[packet_steps], depth[packet_steps];
  M perhaps[packet_steps], any = hn::Lt(all(inf), all(inf));
  if (plane)
    each([&](std::size_t k) { edge[k] = all(inf); });
  else
    each([&](std::size_t k) { edge[k] = p.least_edge(u(k), v(k)); });
  const auto known = [&](std::size_t k) { return hn::Gt(depth[k], p.depth_floor()); };
  each([&](std::size_t k) {
    depth[k] = p.reciprocal_depth(u(k), v(k));
    const M behind = hn::And(hn::Lt(depth[k], hn::Sub(far(k), p.depth_error())), known(k));
    const M near =
        hn::AndNot(behind, hn::And(hn::Lt(far(k), all(inf)), hn::Ge(edge[k], hn::Neg(p.edge_error()))));
    const auto leaves = hn::Eq(hn::Load(ids, rays.source + at + k * lanes()), hn::Set(ids, blocker.not_from));
    perhaps[k] = hn::AndNot(hn::RebindMask(f, leaves), near);
    any = hn::Or(any, perhaps[k]);
  });
  Blocked blocked;
  if (hn::AllFalse(f, any)) [[likely]]
    return blocked;
  each([&](std::size_t k) {
    const M ahead = hn::And(hn::Gt(depth[k], hn::Add(far(k), p.depth_error())), known(k));
    const M surely = hn::And(perhaps[k], hn::And(hn::Gt(edge[k], p.edge_error()), ahead));
    blocked.perhaps |= bits_of(perhaps[k]) << k * lanes();
    if (blocker.may_be_sure) blocked.surely |= bits_of(surely) << k * lanes();
  });
  return blocked;
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
