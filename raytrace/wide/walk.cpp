#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/wide/walk.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstring>

#include "raytrace/wide/walk.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, node_lanes>;
using U = hn::RebindToUnsigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;
constexpr F f;
[[maybe_unused]] constexpr U ids;
constexpr std::size_t lanes = hn::MaxLanes(f);
static_assert(node_lanes % lanes == 0 && node_lanes == 16 && !HWY_HAVE_SCALABLE);

inline V all(float v) {
  return hn::Set(f, v);
}
template <class Tag, class Mask>
HWY_INLINE unsigned bits_of(Tag tag, Mask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(tag, mask, bytes);
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

/// Fills the ray; false: refused. The order of operations is that of raytrace/wide/ray.h.
HWY_INLINE bool prepare(const WideTree& tree, const Ray& given, const WalkLimits& limits, WideRay& ray) {
  static_assert(sizeof(Ray) == 8 * sizeof(double) && offsetof(Ray, direction) == 3 * sizeof(double));
  using D = hn::CappedTag<double, 4>;
  using Half = hn::Rebind<float, D>;
  constexpr D d;
  constexpr Half half;
  const auto* numbers = reinterpret_cast<const double*>(&given);
  const double largest = std::max(std::max(std::abs(numbers[3]), std::abs(numbers[4])), std::abs(numbers[5]));
  if (!(largest >= 0x1p-900 && largest <= 0x1p900)) return false;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) & (0x7ffull << 52);
  const double kernel_t = std::bit_cast<double>(exponent + (1ull << 52));
  const auto scale = hn::Set(d, std::bit_cast<double>((2045ull << 52) - exponent));
  const float r = tree.reach;
  const auto narrowest = hn::Set(half, WideRay::least_direction);
  unsigned good = 0, backwards = 0;
  for (std::size_t i = 0; i < 4; i += hn::MaxLanes(d)) {
    const auto o =
        hn::DemoteTo(half, hn::Sub(hn::LoadU(d, numbers + i), hn::Load(d, tree.center.data() + i)));
    const auto v = hn::DemoteTo(half, hn::Mul(hn::LoadU(d, numbers + 3 + i), scale));
    const auto inverse = hn::Div(
        hn::Set(half, 1.0f), hn::IfThenElse(hn::Lt(hn::Abs(v), narrowest), hn::CopySign(narrowest, v), v));
    const auto middle = hn::Mul(hn::Neg(o), inverse);
    const auto slack = hn::Mul(hn::Mul(hn::Set(half, 0x1p-20f), hn::Abs(inverse)),
                               hn::Add(hn::Set(half, 0x1p-10f * r), hn::Abs(o)));
    hn::Store(o, half, ray.origin + i), hn::Store(v, half, ray.direction + i);
    hn::Store(inverse, half, ray.inverse + i);
    hn::Store(hn::Sub(middle, slack), half, ray.near + i);
    const auto widening = hn::Set(half, WideRay::widening);
    hn::Store(hn::Mul(inverse, widening), half, ray.far_inverse + i);
    hn::Store(hn::Mul(hn::Add(middle, slack), widening), half, ray.far + i);
    const auto bits = [&](auto mask) { return bits_of(half, mask) << i; };
    good |=
        bits(hn::And(hn::Le(hn::Abs(o), hn::Set(half, 64.0f * r)), hn::Le(hn::Abs(v), hn::Set(half, 1.0f))));
    backwards |= bits(hn::Lt(inverse, hn::Zero(half)));
  }
  constexpr unsigned axes = 7;
  const double t_min = given.t.min * kernel_t, t_max = given.t.max * kernel_t;
  if ((good & axes) != axes || !(t_min >= 0.0 && t_min <= 0x1p100 && t_min <= t_max) ||
      limits.origin_error > 0x1p-44 * static_cast<double>(r))
    return false;
  const float q =
      std::max(std::max(std::abs(ray.origin[0]), std::abs(ray.origin[1])), std::abs(ray.origin[2]));
  ray.octant = backwards & axes;
  const auto doubt = [](float t) { return t * FLT_EPSILON + FLT_MIN; };  // as float_above and float_below
  const auto least = static_cast<float>(t_min), most = static_cast<float>(t_max);
  ray.t_min = std::max(0.0f, least - doubt(least)), ray.surely_after = least + doubt(least);
  ray.t_max = (most + doubt(most)) * WideRay::widening;
  ray.surely_before = most <= FLT_MAX ? most - doubt(most) : FLT_MAX;
  ray.limit(limits.t_above);
  ray.distance_error = 0x1.001p-20f * (r + q);
  return true;
}

/// Children that the ray may yet meet, the next one last.
struct Stack {
  // A level leaves at most fifteen behind; the last store may write sixteen.
  static constexpr std::size_t most = 15 * Bvh::max_depth + 2 * node_lanes;
  std::uint32_t child[most];
  float near[most];
};

/// The ray in every lane, and where in a node the near and the far planes are.
struct SpreadRay {
  V inverse[3], near[3], far_inverse[3], far[3], t_min;
  std::size_t near_row[3], far_row[3];  // bytes
  int octant_shift;
  explicit SpreadRay(const WideRay& ray)
      : t_min(all(ray.t_min)), octant_shift(static_cast<int>(4 * ray.octant)) {
    constexpr std::size_t row = sizeof(WideNode::bounds[0]);
    for (std::size_t a = 0; a < 3; ++a) {
      inverse[a] = all(ray.inverse[a]), near[a] = all(ray.near[a]);
      far_inverse[a] = all(ray.far_inverse[a]), far[a] = all(ray.far[a]);
      near_row[a] = row * ((ray.octant >> a & 1u) != 0 ? 3 + a : a);
      far_row[a] = row * (2 * a + 3) - near_row[a];
    }
  }
};

/// Where the ray enters and leaves the boxes from the i-th on.
HWY_INLINE void meet_children(const WideNode& node, const SpreadRay& ray, std::size_t i, V t_max, V& near,
                              V& far) {
  const char* bounds = reinterpret_cast<const char*>(node.bounds) + i * sizeof(float);
  const auto at = [&](std::size_t row, V inverse, V constant) {
    return hn::MulAdd(hn::Load(f, reinterpret_cast<const float*>(bounds + row)), inverse, constant);
  };
  near = hn::Max(hn::Max(at(ray.near_row[0], ray.inverse[0], ray.near[0]),
                         at(ray.near_row[1], ray.inverse[1], ray.near[1])),
                 hn::Max(at(ray.near_row[2], ray.inverse[2], ray.near[2]), ray.t_min));
  far = hn::Min(hn::Min(at(ray.far_row[0], ray.far_inverse[0], ray.far[0]),
                        at(ray.far_row[1], ray.far_inverse[1], ray.far[1])),
                hn::Min(at(ray.far_row[2], ray.far_inverse[2], ray.far[2]), t_max));
}

/// Takes the children whose boxes the ray may meet: the next one into `next`, the others onto the stack.
/// False: none.
template <std::size_t width = lanes>
HWY_INLINE bool take_children(const WideNode& node, const SpreadRay& ray, float t_max, Stack& stack,
                              std::size_t& size, std::uint32_t& next) {
  if constexpr (width == node_lanes) {
    V near, far;
    meet_children(node, ray, 0, all(t_max), near, far);
    const M met = hn::Le(near, far);
    const unsigned bits = bits_of(f, met);
    if (bits == 0) return false;
    if ((bits & (bits - 1)) == 0) {
      next = node.child[std::countr_zero(bits)];
      return true;
    }
    const V none = all(std::numeric_limits<float>::infinity());
    near = hn::IfThenElse(met, near, none);
    const auto order = hn::And(hn::ShiftRightSame(hn::Load(ids, node.order), ray.octant_shift),
                               hn::Set(ids, node_lanes - 1));
    near = hn::TableLookupLanes(near, hn::IndicesFromVec(f, order));
    const auto child = hn::TableLookupLanes(hn::Load(ids, node.child), hn::IndicesFromVec(ids, order));
    const M ordered = hn::Lt(near, none);
    hn::StoreU(hn::Compress(child, hn::RebindMask(ids, ordered)), ids, stack.child + size);
    hn::StoreU(hn::Compress(near, ordered), f, stack.near + size);
    size += static_cast<std::size_t>(std::popcount(bits));
  } else {
    alignas(64) float nears[node_lanes];
    unsigned met = 0;
    for (std::size_t i = 0; i < node_lanes; i += width) {
      V near, far;
      meet_children(node, ray, i, all(t_max), near, far);
      hn::Store(near, f, nears + i);
      met |= bits_of(f, hn::Le(near, far)) << i;
    }
    if (met == 0) return false;
    const std::size_t base = size;
    for (; met != 0; met &= met - 1) {  // the farthest at the bottom
      const auto lane = static_cast<std::size_t>(std::countr_zero(met));
      std::size_t at = size++;
      for (; at > base && stack.near[at - 1] < nears[lane]; --at)
        stack.child[at] = stack.child[at - 1], stack.near[at] = stack.near[at - 1];
      stack.child[at] = node.child[lane], stack.near[at] = nears[lane];
    }
  }
  next = stack.child[--size];
  return true;
}

/// What the floats say of a leaf's triangles.
struct LeafTest {
  unsigned candidates = 0, sure = 0;
  alignas(32) float numerator[leaf_lanes], determinant[leaf_lanes], error[leaf_lanes];

  LeafTest(const WideLeaf& leaf, const WideRay& ray) {
    using L = hn::CappedTag<float, leaf_lanes>;
    constexpr L l;
    constexpr std::size_t step = hn::MaxLanes(l);
    const auto every = [](float v) { return hn::Set(L(), v); };
    using W = hn::Vec<L>;
    struct V3 {
      W x, y, z;
    };
    const auto cross = [](const V3& a, const V3& b) {
      const auto part = [](W p, W q, W r, W s) { return hn::NegMulAdd(r, s, hn::Mul(p, q)); };
      return V3{part(a.y, b.z, a.z, b.y), part(a.z, b.x, a.x, b.z), part(a.x, b.y, a.y, b.x)};
    };
    const auto dot = [](const V3& a, const V3& b) {
      return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
    };
    const W size = every(leaf.size);
    const V3 d{every(ray.direction[0]), every(ray.direction[1]), every(ray.direction[2])};
    for (std::size_t i = 0; i < leaf_lanes; i += step) {
      const auto row = [&](std::size_t k) { return hn::Load(l, leaf.rows[k] + i); };
      const auto from = [&](std::size_t a) { return hn::Sub(every(ray.origin[a]), row(a)); };
      const V3 s{from(0), from(1), from(2)}, e1{row(3), row(4), row(5)}, e2{row(6), row(7), row(8)};
      const V3 p = cross(d, e2), q = cross(s, e1);
      const W det = dot(e1, p), u = dot(s, p), v = dot(d, q), w = hn::Sub(hn::Sub(det, u), v);
      const W distance = hn::Add(hn::Add(hn::Abs(s.x), hn::Abs(s.y)), hn::Abs(s.z));
      const W e =
          hn::Mul(size, hn::MulAdd(every(0x1p-18f), hn::Add(size, distance), every(ray.distance_error)));
      const W least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
      const auto missed = hn::And(hn::Lt(least, hn::Neg(e)), hn::Gt(most, e));
      const unsigned left = (leaf.lanes >> i) & ~bits_of(l, missed);
      if ((left & ((1u << step) - 1)) == 0) continue;
      candidates |= (left & ((1u << step) - 1)) << i;
      sure |= bits_of(l, hn::Or(hn::Gt(least, e), hn::Lt(most, hn::Neg(e)))) << i;
      hn::Store(hn::CopySign(det, every(1.0f)), l, determinant + i);
      hn::Store(hn::Xor(dot(e2, q), hn::And(det, every(-0.0f))), l, numerator + i);
      hn::Store(e, l, error + i);
    }
  }
  bool is_sure(unsigned i) const { return (sure >> i & 1u) != 0; }
  /// Between which t a sure one is met.
  float t_below(unsigned i, float size) const {
    const float t = (numerator[i] - size * error[i]) / (determinant[i] + error[i]);
    return t - std::abs(t) * 0x1p-20f;
  }
  float t_above(unsigned i, float size) const {
    const float t = (numerator[i] + size * error[i]) / (determinant[i] - error[i]);
    return t + std::abs(t) * 0x1p-20f;
  }
};

/// Asks memory ahead of need for a child that comes after the next one.
HWY_INLINE void prefetch(const WideNode* nodes, const WideLeaf* leaves, WideChild child) {
  const char* bytes = child.is_leaf() ? reinterpret_cast<const char*>(leaves + child.index())
                                      : reinterpret_cast<const char*>(nodes + child.index());
  constexpr std::size_t line = 64;
  static_assert(sizeof(WideNode) == 8 * line && sizeof(WideLeaf) == 10 * line);
  for (std::size_t i = 0; i < 4; ++i) __builtin_prefetch(bytes + i * line);
}

/// leaf(WideLeaf) returns true to end the walk.
template <class Leaf>
HWY_INLINE WideWalk walk(const WideTree& tree, WideRay& ray, const Leaf& leaf) {
  const SpreadRay spread(ray);
  const WideNode* nodes = tree.nodes.data();
  const WideLeaf* leaves = tree.leaves.data();
  float t_max = ray.t_max;
  Stack stack;
  std::size_t size = 0;
  std::size_t known = 0;  // on the stack, asked for already
  WideChild child{0};
  for (;;) {
    if (child.is_leaf()) {
      if (leaf(leaves[child.index()])) return WideWalk::ended;
      t_max = ray.t_max;
    } else if (take_children(nodes[child.index()], spread, t_max, stack, size, child.bits)) {
      if (size > known) prefetch(nodes, leaves, WideChild{stack.child[size - 1]});
      known = size;
      continue;
    }
    do {
      if (size == 0) return WideWalk::done;
      child.bits = stack.child[--size];
    } while (stack.near[size] > t_max);
    if (size > 0) prefetch(nodes, leaves, WideChild{stack.child[size - 1]});
    known = size;
  }
}

/// False: no room.
inline bool keep(LeafCandidates& found, std::uint32_t leaf, float t, const WideRay& ray) {
  if (found.count == LeafCandidates::most) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i)
      if (found.t[i] <= ray.t_max) found.leaf[kept] = found.leaf[i], found.t[kept++] = found.t[i];
    found.count = kept;
    if (kept == LeafCandidates::most) return false;
  }
  found.leaf[found.count] = leaf, found.t[found.count++] = t;
  return true;
}

/// candidate(leaf, i, test) for each; true ends.
template <class Candidate>
HWY_INLINE bool each_candidate(const WideLeaf& leaf, const WideRay& ray, const Candidate& candidate) {
  const LeafTest test(leaf, ray);
  for (unsigned left = test.candidates; left != 0; left &= left - 1)
    if (candidate(static_cast<unsigned>(std::countr_zero(left)), test)) return true;
  return false;
}

WideWalk closest_kernel(const WideTree& tree, const Ray& given, LeafCandidates& found) {
  WideRay ray;
  if (!prepare(tree, given, {}, ray)) return WideWalk::refused;
  const auto walked = walk(tree, ray, [&](const WideLeaf& leaf) {
    return each_candidate(leaf, ray, [&](unsigned i, const LeafTest& test) {
      float t = -std::numeric_limits<float>::infinity();
      if (test.is_sure(i)) {
        t = test.t_below(i, leaf.size);
        const float above = test.t_above(i, leaf.size);
        if (t > ray.t_max || above < ray.t_min) return false;
        if (t > ray.surely_after) ray.limit(above);
      }
      tree.origin->prefetch(leaf.first + i);
      return !keep(found, leaf.first + i, t, ray);
    });
  });
  found.t_max = ray.t_max;
  return walked == WideWalk::ended ? WideWalk::refused : walked;
}

WideWalk visit_kernel(const WideTree& tree, const Ray& given, const WalkLimits& limits,
                      CandidateVisitor visitor) {
  WideRay ray;
  if (!prepare(tree, given, limits, ray)) return WideWalk::refused;
  return walk(tree, ray, [&](const WideLeaf& leaf) {
    return each_candidate(leaf, ray, [&](unsigned i, const LeafTest&) {
      return visitor.visit(visitor.self, leaf.first + i, ray);
    });
  });
}

WideWalk doubtful_kernel(const WideTree& tree, const Ray& given, CandidateVisitor visitor) {
  WideRay ray;
  if (!prepare(tree, given, {}, ray)) return WideWalk::refused;
  return walk(tree, ray, [&](const WideLeaf& leaf) {
    return each_candidate(leaf, ray, [&](unsigned i, const LeafTest& test) {
      if (test.is_sure(i)) {
        const float below = test.t_below(i, leaf.size), above = test.t_above(i, leaf.size);
        if (below > ray.surely_after && above < ray.surely_before) return true;
        if (above < ray.t_min || below > ray.t_max) return false;
      }
      return visitor.visit(visitor.self, leaf.first + i, ray);
    });
  });
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(closest_kernel);
HWY_EXPORT(visit_kernel);
HWY_EXPORT(doubtful_kernel);

WideWalk closest_candidates(const WideTree& tree, const Ray& ray, LeafCandidates& found) {
  return HWY_DYNAMIC_DISPATCH(closest_kernel)(tree, ray, found);
}
WideWalk visit_candidates(const WideTree& tree, const Ray& ray, const WalkLimits& limits,
                          CandidateVisitor visitor) {
  return HWY_DYNAMIC_DISPATCH(visit_kernel)(tree, ray, limits, visitor);
}
WideWalk visit_doubtful(const WideTree& tree, const Ray& ray, CandidateVisitor visitor) {
  return HWY_DYNAMIC_DISPATCH(doubtful_kernel)(tree, ray, visitor);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
