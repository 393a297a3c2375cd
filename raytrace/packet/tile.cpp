// The walk of raytrace/packet/tile.h. Boxes are culled against the tile's frustum (or column), triangles
// against the intervals of all 16 packets at once (Reshetov, Soupikov, Hurley 2005, "Multi-level ray tracing
// algorithm", section 3), what is left is tested 16 rays at a time. The interval tests are made of the same
// operations as the ray tests, and rounding is monotone, so they never cull what a ray test would keep.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/tile.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>
#include <cstring>
#include <limits>

#include "raytrace/packet/tile.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, packet_rays>;
using I = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;
constexpr F f;
constexpr I ids;
using Four = hn::CappedTag<float, 4>;
constexpr Four four;
constexpr float inf = std::numeric_limits<float>::infinity();

inline std::size_t lanes() {
  return hn::Lanes(f);
}
inline V all(float v) {
  return hn::Set(f, v);
}
inline unsigned bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(f, mask, bytes);
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}
inline M mask_of(unsigned bits) {
  std::uint8_t bytes[8] = {};
  std::memcpy(bytes, &bits, sizeof bits);
  return hn::LoadMaskBits(f, bytes);
}

/// A function of d = (u, v, 1), in the tile's axes.
struct Linear {
  float u, v, constant;
};
/// The order of operations that everything here shares.
inline V value(V cu, V cv, V constant, V u, V v) {
  return hn::MulAdd(cu, u, hn::MulAdd(cv, v, constant));
}

struct Axes {
  std::size_t u, v, depth;
  float sign;
  Linear of(const float (&n)[3]) const { return {n[u], n[v], sign * n[depth]}; }
};

inline Axes axes_of(const Seen& seen, const TileRays& rays) {
  if (seen.directional) return {0, 1, 2, 1.0f};
  const auto depth = static_cast<std::size_t>(rays.axis);
  return {(depth + 1) % 3, (depth + 2) % 3, depth, rays.sign};
}

/// Per packet the intervals of its rays.
struct alignas(64) Packets {
  float u_min[tile_packets], u_max[tile_packets], v_min[tile_packets], v_max[tile_packets];
  float far_min[tile_packets];  ///< +infinity: no ray of it asks any more
};

/// A lower bound u·d_u + v·d_v + constant of shadow rays' `far`: receivers on one plane lie on it exactly,
/// for nearness is linear there. So a surface's own triangles are told to be behind its receivers.
struct Floor {
  float u = 0.0f, v = 0.0f, constant = 0.0f;
};
struct alignas(64) Floors {
  float u[tile_packets], v[tile_packets], constant[tile_packets];
};

/// The slopes of the plane through three rays' receivers; none when they are too much in a line.
inline Floor slopes_through(const TileRays& r, std::size_t a, std::size_t b, std::size_t c) {
  const float du1 = r.u[b] - r.u[a], dv1 = r.v[b] - r.v[a], df1 = r.far[b] - r.far[a];
  const float du2 = r.u[c] - r.u[a], dv2 = r.v[c] - r.v[a], df2 = r.far[c] - r.far[a];
  const float det = du1 * dv2 - du2 * dv1;
  const float size = du1 * du1 + dv1 * dv1 + du2 * du2 + dv2 * dv2;
  if (!(std::abs(det) > 1e-3f * size)) return {};
  const Floor floor{(df1 * dv2 - df2 * dv1) / det, (du1 * df2 - du2 * df1) / det, 0.0f};
  return std::abs(floor.u) < 1e15f && std::abs(floor.v) < 1e15f ? floor : Floor{};
}

/// The first three corners, of four, that are asked for decide the slopes.
inline Floor slopes_of(const TileRays& r, const std::array<std::size_t, 4>& corners) {
  std::array<std::size_t, 4> found{};
  std::size_t count = 0;
  for (const std::size_t i : corners)
    if ((r.alive[i / packet_rays] >> (i % packet_rays) & 1) != 0) found[count++] = i;
  return count < 3 ? Floor{} : slopes_through(r, found[0], found[1], found[2]);
}

/// Sets the constant so that rays first … first + count lie above, by more than rounding (far: +infinity for
/// rays not asked for).
inline void lower(const TileRays& rays, const float* far, std::size_t first, std::size_t count,
                  Floor& floor) {
  V least = all(inf), scale = all(0.0f);
  const V gu = all(floor.u), gv = all(floor.v);
  for (std::size_t i = first; i < first + count; i += lanes()) {
    const V u = hn::Load(f, rays.u + i), v = hn::Load(f, rays.v + i), at = hn::Load(f, far + i);
    const M asked = hn::Lt(at, all(inf));
    const V tu = hn::Mul(gu, u), tv = hn::Mul(gv, v);
    least = hn::Min(least, hn::IfThenElse(asked, hn::Sub(hn::Sub(at, tu), tv), least));
    const V size = hn::Add(hn::Abs(at), hn::Add(hn::Abs(tu), hn::Abs(tv)));
    scale = hn::Max(scale, hn::IfThenElseZero(asked, size));
  }
  constexpr float rounding = 0x1p-19f;
  floor.constant = hn::GetLane(hn::MinOfLanes(f, least)) - rounding * hn::GetLane(hn::MaxOfLanes(f, scale));
}

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

inline float smallest(const float* values) {
  V least = hn::Load(f, values);
  for (std::size_t i = lanes(); i < packet_rays; i += lanes())
    least = hn::Min(least, hn::Load(f, values + i));
  return hn::GetLane(hn::MinOfLanes(f, least));
}
inline float largest(const float* values) {
  V most = hn::Load(f, values);
  for (std::size_t i = lanes(); i < packet_rays; i += lanes()) most = hn::Max(most, hn::Load(f, values + i));
  return hn::GetLane(hn::MaxOfLanes(f, most));
}

/// The tile's region as four planes and a depth; for each the box corner farthest along it is looked at.
class Frustum {
 public:
  static constexpr std::size_t sides = 4;

  Frustum(const Bvh& bvh, const Seen& seen, const Axes& axes, const Packets& packets) {
    const Vec3 origin = seen.origin - bvh.center;
    const double u_min = smallest(packets.u_min), u_max = largest(packets.u_max);
    const double v_min = smallest(packets.v_min), v_max = largest(packets.v_max);
    const Vec3 u = seen.axes[axes.u], v = seen.axes[axes.v],
               depth = static_cast<double>(axes.sign) * seen.axes[axes.depth];
    if (seen.directional) {
      set(0, u, -u_min - glm::dot(u, origin), seen), set(1, -u, u_max + glm::dot(u, origin), seen);
      set(2, v, -v_min - glm::dot(v, origin), seen), set(3, -v, v_max + glm::dot(v, origin), seen);
      set(4, depth, -glm::dot(depth, origin), seen);
    } else {
      const auto side = [&](std::size_t k, const Vec3& n) { set(k, n, -glm::dot(n, origin), seen); };
      side(0, u - u_min * depth), side(1, u_max * depth - u);
      side(2, v - v_min * depth), side(3, v_max * depth - v);
      side(4, -depth);
    }
  }

  /// Boxes wholly behind the floor are left out as well.
  void stand_on(const Floor& floor, const Bvh& bvh, const Seen& seen, const Axes& axes) {
    const Vec3 origin = seen.origin - bvh.center;
    const Vec3 u = seen.axes[axes.u], v = seen.axes[axes.v],
               depth = static_cast<double>(axes.sign) * seen.axes[axes.depth];
    const double gu = floor.u, gv = floor.v, gc = floor.constant;
    // Of a point: nearness 1 / z > g·(x / z, y / z, 1). Scaled so that the slack is in world units.
    Vec3 n = -(gu * u + gv * v + gc * depth);
    double constant = 1.0;
    if (seen.directional) n = depth - gu * u - gv * v, constant = -gc;
    const double length = glm::length(n);
    if (!(length > 1e-30 && length < 1e30)) return;
    set(5, n / length, (constant - glm::dot(n, origin)) / length, seen);
    planes_ = 6;
  }

  /// Bit i: child i may be met by a ray of the tile at a priority of at least `limit` (priority: minus the
  /// depth of a point's boxes, the height of a direction's).
  unsigned meets(const BvhNode& node, float limit, float* priority) const {
    unsigned met = 0;
    for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
      auto least = along(node, 0, i);
      for (std::size_t k = 1; k < sides; ++k) least = hn::Min(least, along(node, k, i));
      if (planes_ == 6) least = hn::Min(least, along(node, 5, i));
      const auto order = along(node, 4, i);
      hn::Store(order, four, priority + i);
      const auto keep = hn::And(hn::Ge(least, hn::Zero(four)), hn::Ge(order, hn::Set(four, limit)));
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(four, keep, bytes);
      met |= static_cast<unsigned>(bytes[0]) << i;
    }
    return met;
  }

 private:
  void set(std::size_t k, const Vec3& n, double constant, const Seen& seen) {
    for (std::size_t a = 0; a < 3; ++a) {
      n_[k][a] = static_cast<float>(n[static_cast<int>(a)]);
      row_[k][a] = n_[k][a] > 0.0f ? 3 + a : a;
    }
    c_[k] = float_above(constant + 4.0 * seen.slack);
  }
  hn::Vec<Four> along(const BvhNode& node, std::size_t k, std::size_t i) const {
    auto sum = hn::Set(four, c_[k]);
    for (std::size_t a = 0; a < 3; ++a)
      sum = hn::MulAdd(hn::Set(four, n_[k][a]), hn::Load(four, node.bounds[row_[k][a]] + i), sum);
    return sum;
  }

  float n_[6][3], c_[6];
  std::size_t row_[6][3];
  std::size_t planes_ = 5;
};

/// Visits the leaves that the tile may meet, highest priority first: leaf(first, count) returns false to end
/// the walk; limit() is the least priority still of interest.
template <class Leaf, class Limit>
void walk_tile(const Bvh& bvh, const Frustum& frustum, const Limit& limit, const Leaf& leaf) {
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
    for (unsigned mask = frustum.meets(node, limit(), priority); mask != 0; mask &= mask - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(mask));
      std::size_t at = size++;
      for (; at > base && stack[at - 1].priority > priority[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[i], priority[i]};
    }
  }
}

/// One primitive's functions in the tile's axes.
struct Functions {
  Linear edge[3], nearness;
  Functions(const SeenPrimitive& p, const Axes& axes)
      : edge{axes.of(p.edge[0]), axes.of(p.edge[1]), axes.of(p.edge[2])}, nearness(axes.of(p.nearness)) {}
};

/// Bit p: packet p may meet the primitive in front of what it knows already.
template <class Behind>
unsigned packets_met(const SeenPrimitive& p, const Functions& of, const Packets& packets,
                     const Behind& behind) {
  const auto most = [&](const Linear& l, std::size_t i) {
    const float* u = l.u > 0.0f ? packets.u_max : packets.u_min;
    const float* v = l.v > 0.0f ? packets.v_max : packets.v_min;
    return value(all(l.u), all(l.v), all(l.constant), hn::Load(f, u + i), hn::Load(f, v + i));
  };
  const bool by_depth = !(p.depth_floor > -1e30f);
  unsigned met = 0;
  for (std::size_t i = 0; i < tile_packets; i += lanes()) {
    const V edges = hn::Min(most(of.edge[0], i), hn::Min(most(of.edge[1], i), most(of.edge[2], i)));
    const V far = hn::Load(f, packets.far_min + i);
    M keep = hn::And(hn::Ge(edges, all(-p.edge_error)), hn::Lt(far, all(inf)));
    if (by_depth) {
      const V depth_error = all(p.depth_error);
      keep = hn::AndNot(hn::Lt(most(of.nearness, i), hn::Sub(far, depth_error)), keep);
      keep = hn::AndNot(behind(of.nearness, depth_error, i), keep);
    }
    met |= bits_of(keep) << i;
  }
  return met;
}

/// Rays against one primitive: the least edge function and the nearness.
class RayTest {
 public:
  explicit RayTest(const Functions& of)
      : e0u_(all(of.edge[0].u)),
        e0v_(all(of.edge[0].v)),
        e0c_(all(of.edge[0].constant)),
        e1u_(all(of.edge[1].u)),
        e1v_(all(of.edge[1].v)),
        e1c_(all(of.edge[1].constant)),
        e2u_(all(of.edge[2].u)),
        e2v_(all(of.edge[2].v)),
        e2c_(all(of.edge[2].constant)),
        mu_(all(of.nearness.u)),
        mv_(all(of.nearness.v)),
        mc_(all(of.nearness.constant)) {}
  V least_edge(V u, V v) const {
    return hn::Min(value(e0u_, e0v_, e0c_, u, v),
                   hn::Min(value(e1u_, e1v_, e1c_, u, v), value(e2u_, e2v_, e2c_, u, v)));
  }
  V nearness(V u, V v) const { return value(mu_, mv_, mc_, u, v); }

 private:
  V e0u_, e0v_, e0c_, e1u_, e1v_, e1c_, e2u_, e2v_, e2c_, mu_, mv_, mc_;
};

/// The closest hits of a tile. Of each ray the best sure hit's nearness is known to lie in [low, high], and
/// no other hit is nearer than `doubt`.
class Closest {
 public:
  Closest(const Bvh& bvh, const Seen& seen, const TileRays& rays)
      : bvh_(bvh), seen_(seen), rays_(rays), axes_(axes_of(seen, rays)) {
    gather_packets(rays, packets_);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      packets_.far_min[p] = rays.alive[p] != 0 ? 0.0f : inf;
      for (std::size_t i = 0; i < packet_rays; i += lanes()) {
        const std::size_t at = p * packet_rays + i;
        const V start =
            hn::IfThenElse(mask_of(static_cast<unsigned>(rays.alive[p]) >> i), all(0.0f), all(inf));
        hn::Store(start, f, low_ + at), hn::Store(start, f, high_ + at);
        hn::Store(all(-inf), f, doubt_ + at);
        hn::Store(hn::Set(ids, nothing_hit), ids, leaf_ + at);
      }
    }
  }

  void run(TileHits& hits) {
    for (std::uint32_t i = 0; i < seen_.planes.size(); ++i)
      for (std::size_t p = 0; p < tile_packets; ++p) test<true>(seen_.planes[i], first_plane + i, p);
    const Frustum frustum(bvh_, seen_, axes_, packets_);
    update_limit();
    walk_tile(
        bvh_, frustum, [&] { return limit_; },
        [&](std::uint32_t first, std::uint32_t count) {
          bool taken = false;
          for (std::uint32_t i = first; i < first + count; ++i) taken |= visit(i);
          if (taken) update_limit();
          return true;
        });
    for (std::size_t i = 0; i < tile_rays; i += lanes()) {
      const M unsure = hn::Ge(hn::Load(f, doubt_ + i), hn::Load(f, low_ + i));
      const auto leaf =
          hn::IfThenElse(hn::RebindMask(ids, unsure), hn::Set(ids, unsure_hit), hn::Load(ids, leaf_ + i));
      hn::Store(leaf, ids, hits.leaf + i);
    }
  }

 private:
  bool visit(std::uint32_t i) {
    const SeenPrimitive& primitive = seen_.primitives[i];
    const Functions of(primitive, axes_);
    unsigned met = packets_met(primitive, of, packets_,
                               [](const Linear&, V error, std::size_t) { return hn::Lt(error, error); });
    if (met == 0) return false;
    const RayTest rays(of);
    bool taken = false;
    for (; met != 0; met &= met - 1)
      taken |= test_packet<false>(primitive, rays, i, static_cast<std::size_t>(std::countr_zero(met)));
    return taken;
  }
  template <bool plane>
  void test(const SeenPrimitive& primitive, std::uint32_t leaf, std::size_t packet) {
    test_packet<plane>(primitive, RayTest(Functions(primitive, axes_)), leaf, packet);
  }

  template <bool plane>
  bool test_packet(const SeenPrimitive& primitive, const RayTest& rays, std::uint32_t leaf,
                   std::size_t packet) {
    bool taken = false;
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const std::size_t at = packet * packet_rays + i;
      const V u = hn::Load(f, rays_.u + at), v = hn::Load(f, rays_.v + at);
      const V edge = plane ? all(inf) : rays.least_edge(u, v);
      const V edge_error = all(primitive.edge_error), depth_error = all(primitive.depth_error);
      const V nearness = rays.nearness(u, v);
      const V low = hn::Load(f, low_ + at), high = hn::Load(f, high_ + at);
      const M known = hn::Gt(nearness, all(primitive.depth_floor));
      const M behind = hn::And(hn::Lt(nearness, hn::Sub(low, depth_error)), known);
      const M contact = hn::AndNot(behind, hn::Ge(edge, hn::Neg(edge_error)));
      if (hn::AllFalse(f, contact)) continue;
      taken |=
          record(primitive, leaf, at, contact, hn::And(hn::Gt(edge, edge_error), known), nearness, low, high);
    }
    if (taken) packets_.far_min[packet] = smallest_low(packet);
    return taken;
  }

  bool record(const SeenPrimitive& primitive, std::uint32_t leaf, std::size_t at, M contact, M inside,
              V nearness, V low, V high) {
    const V depth_error = all(primitive.depth_error);
    const bool may_be_sure = (primitive.id & never_sure) == 0;
    const M sure = hn::And(contact, may_be_sure ? inside : hn::Lt(low, low));
    const V new_low = hn::Sub(nearness, depth_error);
    const V new_high = hn::IfThenElse(hn::Gt(nearness, all(primitive.depth_floor)),
                                      hn::Add(nearness, depth_error), all(inf));
    const M take = hn::And(sure, hn::Gt(new_low, low));
    // Surely nearer than all that was sure before: the old best is no rival. Otherwise the loser is a doubt.
    const M rival = hn::AndNot(hn::And(take, hn::Gt(new_low, high)), contact);
    const V doubt = hn::Load(f, doubt_ + at), loser = hn::IfThenElse(take, high, new_high);
    hn::Store(hn::IfThenElse(rival, hn::Max(doubt, loser), doubt), f, doubt_ + at);
    if (hn::AllFalse(f, take)) return false;
    hn::Store(hn::IfThenElse(take, new_low, low), f, low_ + at);
    hn::Store(hn::IfThenElse(take, new_high, high), f, high_ + at);
    const auto old = hn::Load(ids, leaf_ + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(ids, take), hn::Set(ids, leaf), old), ids, leaf_ + at);
    return true;
  }

  float smallest_low(std::size_t packet) const { return smallest(low_ + packet * packet_rays); }
  // The farthest depth at which any ray may still find something nearer, as a priority.
  void update_limit() {
    const float far = smallest(packets_.far_min);
    limit_ = far > 0.0f ? -(1.0f / far) * (1.0f + 0x1p-20f) : -inf;
  }

  const Bvh& bvh_;
  const Seen& seen_;
  const TileRays& rays_;
  Axes axes_;
  Packets packets_;
  float limit_ = -inf;
  alignas(64) float low_[tile_rays], high_[tile_rays], doubt_[tile_rays];
  alignas(64) std::uint32_t leaf_[tile_rays];
};

class Shadows {
 public:
  Shadows(const Bvh& bvh, const Seen& seen, const TileRays& rays)
      : bvh_(bvh), seen_(seen), rays_(rays), axes_(axes_of(seen, rays)) {
    gather_packets(rays, packets_);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      for (std::size_t i = 0; i < packet_rays; i += lanes()) {
        const std::size_t at = p * packet_rays + i;
        const M alive = mask_of(static_cast<unsigned>(rays.alive[p]) >> i);
        hn::Store(hn::IfThenElse(alive, hn::Load(f, rays.far + at), all(inf)), f, far_ + at);
      }
      packets_.far_min[p] = smallest(far_ + p * packet_rays);
      const std::size_t at = p * packet_rays;
      Floor floor = slopes_of(rays, {at, at + 3, at + 12, at + 15});
      lower(rays, far_, at, packet_rays, floor);
      floors_.u[p] = floor.u, floors_.v[p] = floor.v, floors_.constant[p] = floor.constant;
    }
  }

  void run(TileShadows& out) {
    shadowed_.fill(0), unsure_.fill(0);
    for (const SeenPrimitive& plane : seen_.planes) {
      const RayTest rays(Functions(plane, axes_));
      for (std::size_t p = 0; p < tile_packets; ++p) test_packet<true>(plane, rays, p);
    }
    const float far = smallest(packets_.far_min);
    if (far < inf) {
      Frustum frustum(bvh_, seen_, axes_, packets_);
      Floor floor =
          slopes_of(rays_, {tile_lane(0, 0), tile_lane(15, 0), tile_lane(0, 15), tile_lane(15, 15)});
      lower(rays_, far_, 0, tile_rays, floor);
      frustum.stand_on(floor, bvh_, seen_, axes_);
      const float limit = seen_.directional ? far : far > 0.0f ? -(1.0f / far) * (1.0f + 0x1p-20f) : -inf;
      walk_tile(
          bvh_, frustum, [&] { return limit; },
          [&](std::uint32_t first, std::uint32_t count) {
            bool taken = false;
            for (std::uint32_t i = first; i < first + count; ++i) taken |= visit(i);
            return !taken || smallest(packets_.far_min) < inf;
          });
    }
    for (std::size_t p = 0; p < tile_packets; ++p) {
      out.shadowed[p] = static_cast<std::uint16_t>(shadowed_[p] & rays_.alive[p]);
      out.unsure[p] = static_cast<std::uint16_t>(unsure_[p] & ~shadowed_[p] & rays_.alive[p]);
    }
  }

 private:
  bool visit(std::uint32_t i) {
    const SeenPrimitive& primitive = seen_.primitives[i];
    const Functions of(primitive, axes_);
    unsigned met = packets_met(primitive, of, packets_, [&](const Linear& nearness, V error, std::size_t at) {
      return behind_floor(nearness, error, at);
    });
    if (met == 0) return false;
    const RayTest rays(of);
    bool taken = false;
    for (; met != 0; met &= met - 1)
      taken |= test_packet<false>(primitive, rays, static_cast<std::size_t>(std::countr_zero(met)));
    return taken;
  }

  // The most by which the nearness may exceed the packets' floors, over their intervals.
  M behind_floor(const Linear& nearness, V error, std::size_t i) const {
    const V u = hn::Sub(all(nearness.u), hn::Load(f, floors_.u + i));
    const V v = hn::Sub(all(nearness.v), hn::Load(f, floors_.v + i));
    const V constant = hn::Sub(all(nearness.constant), hn::Load(f, floors_.constant + i));
    const V by_u =
        hn::Max(hn::Mul(u, hn::Load(f, packets_.u_min + i)), hn::Mul(u, hn::Load(f, packets_.u_max + i)));
    const V by_v =
        hn::Max(hn::Mul(v, hn::Load(f, packets_.v_min + i)), hn::Mul(v, hn::Load(f, packets_.v_max + i)));
    return hn::Lt(hn::Add(hn::Add(by_u, by_v), constant), hn::Neg(error));
  }

  template <bool plane>
  bool test_packet(const SeenPrimitive& primitive, const RayTest& rays, std::size_t packet) {
    bool taken = false;
    const V edge_error = all(primitive.edge_error), depth_error = all(primitive.depth_error);
    for (std::size_t i = 0; i < packet_rays; i += lanes()) {
      const std::size_t at = packet * packet_rays + i;
      const V u = hn::Load(f, rays_.u + at), v = hn::Load(f, rays_.v + at);
      const V edge = plane ? all(inf) : rays.least_edge(u, v);
      const V nearness = rays.nearness(u, v), far = hn::Load(f, far_ + at);
      const M known = hn::Gt(nearness, all(primitive.depth_floor));
      const M behind = hn::And(hn::Lt(nearness, hn::Sub(far, depth_error)), known);
      M contact = hn::AndNot(behind, hn::Ge(edge, hn::Neg(edge_error)));
      if (hn::AllFalse(f, contact)) continue;
      const auto own = hn::Eq(hn::Load(ids, rays_.own + at), hn::Set(ids, primitive.id & ~never_sure));
      contact = hn::AndNot(hn::RebindMask(f, own), contact);
      unsure_[packet] |= bits_of(contact) << i;
      if ((primitive.id & never_sure) != 0) continue;
      const M ahead = hn::And(hn::Gt(nearness, hn::Add(far, depth_error)), known);
      const M sure = hn::And(contact, hn::And(hn::Gt(edge, edge_error), ahead));
      const unsigned bits = bits_of(sure);
      if (bits == 0) continue;
      shadowed_[packet] |= bits << i;
      hn::Store(hn::IfThenElse(sure, all(inf), far), f, far_ + at);
      taken = true;
    }
    if (taken) packets_.far_min[packet] = smallest(far_ + packet * packet_rays);
    return taken;
  }

  const Bvh& bvh_;
  const Seen& seen_;
  const TileRays& rays_;
  Axes axes_;
  Packets packets_;
  Floors floors_;
  std::array<unsigned, tile_packets> shadowed_, unsure_;
  alignas(64) float far_[tile_rays];
};

void closest_kernel(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileHits& hits) {
  Closest(bvh, seen, rays).run(hits);
}
void shadows_kernel(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileShadows& shadows) {
  Shadows(bvh, seen, rays).run(shadows);
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(closest_kernel);
HWY_EXPORT(shadows_kernel);

void closest_in_tile(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileHits& hits) {
  HWY_DYNAMIC_DISPATCH(closest_kernel)(bvh, seen, rays, hits);
}
void shadows_in_tile(const Bvh& bvh, const Seen& seen, const TileRays& rays, TileShadows& shadows) {
  HWY_DYNAMIC_DISPATCH(shadows_kernel)(bvh, seen, rays, shadows);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
