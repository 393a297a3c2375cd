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

constexpr float inf = std::numeric_limits<float>::infinity();
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
  ray.t_max = std::min((most + doubt(most)) * WideRay::widening, FLT_MAX);
  ray.surely_before = most <= FLT_MAX ? most - doubt(most) : FLT_MAX;
  ray.limit(limits.t_above);
  ray.coordinate_error = 1.375f * 0x1p-23f * q + 0x1p-34f * r;
  const auto size = [&](std::size_t a) { return std::abs(numbers[3 + a]); };
  const std::uint32_t z = size(2) > std::max(size(0), size(1)) ? 2 : size(0) >= size(1) ? 0 : 1;
  const std::uint32_t x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1;
  ray.axis[0] = x, ray.axis[1] = y, ray.axis[2] = z;
  ray.inverse_z = ray.inverse[z], ray.t_per_z = std::abs(ray.inverse_z);
  ray.direction_x = ray.direction[x], ray.direction_y = ray.direction[y];
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
      : t_min(all(ray.t_min)),
        octant_shift(static_cast<int>(4 * (lanes == node_lanes ? 7 - ray.octant : ray.octant))) {
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
    const V none = all(inf);
    near = hn::IfThenElse(met, near, none);
    const auto order = hn::And(hn::ShiftRightSame(hn::Load(ids, node.order), ray.octant_shift),
                               hn::Set(ids, node_lanes - 1));
    near = hn::TableLookupLanes(near, hn::IndicesFromVec(f, order));
    const auto child = hn::TableLookupLanes(hn::Load(ids, node.child), hn::IndicesFromVec(ids, order));
    const M ordered = hn::Lt(near, none);
    const auto nearest_first = hn::Compress(child, hn::RebindMask(ids, ordered));
    next = hn::GetLane(nearest_first);
    const auto count = static_cast<std::uint32_t>(std::popcount(bits));
    const auto back =
        hn::And(hn::Sub(hn::Set(ids, count - 1), hn::Iota(ids, 0)), hn::Set(ids, node_lanes - 1));
    hn::StoreU(hn::TableLookupLanes(nearest_first, hn::IndicesFromVec(ids, back)), ids, stack.child + size);
    hn::StoreU(hn::TableLookupLanes(hn::Compress(near, ordered), hn::IndicesFromVec(f, back)), f,
               stack.near + size);
    size += count - 1;
    return true;
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

static_assert(leaf_lanes == node_lanes && leaf_corners == leaf_lanes);
constexpr std::size_t leaf_steps = leaf_lanes / lanes;

/// A coordinate of a leaf's corners, to be looked up by the triangles.
struct Corners {
  V part[leaf_steps];
  template <class Index>
  HWY_INLINE V at(Index index) const {
    if constexpr (leaf_steps == 1) {
      return hn::TableLookupLanes(part[0], hn::IndicesFromVec(f, index));
    } else if constexpr (leaf_steps == 2) {
      const auto low = hn::IndicesFromVec(f, hn::And(index, hn::Set(ids, lanes - 1)));
      const auto is_low = hn::RebindMask(f, hn::Lt(index, hn::Set(ids, lanes)));
      return hn::IfThenElse(is_low, hn::TableLookupLanes(part[0], low), hn::TableLookupLanes(part[1], low));
    } else {
      alignas(64) float table[leaf_corners];
      for (std::size_t i = 0; i < leaf_steps; ++i) hn::Store(part[i], f, table + i * lanes);
      return hn::GatherIndex(f, table, hn::BitCast(hn::RebindToSigned<F>(), index));
    }
  }
};

/// What the floats say of a leaf's triangles (raytrace/wide/ray.h).
struct LeafTest {
  unsigned candidates = 0, sure = 0;
  alignas(64) float t_below[leaf_lanes], t_above[leaf_lanes];  ///< of candidates: none is met elsewhere

  HWY_INLINE LeafTest(const WideLeaf& leaf, const WideRay& ray) {
    const auto from = [&](std::size_t k) {
      const std::size_t a = ray.axis[k];
      return hn::Sub(all(ray.origin[a]), all(leaf.anchor[a]));
    };
    const V o[3] = {from(0), from(1), from(2)};
    const V reach = hn::Add(hn::Max(hn::Max(hn::Abs(o[0]), hn::Abs(o[1])), hn::Abs(o[2])), all(leaf.extent));
    const V off = hn::MulAdd(all(12.0f * 0x1p-24f), reach, all(ray.coordinate_error));
    const V wide = hn::MulAdd(all(16.0f), off, all(leaf.size_13));
    const V error = hn::Mul(off, wide), depth_error = hn::Mul(hn::Mul(error, wide), all(ray.t_per_z));
    Corners x, y, t;
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const auto corner = [&](std::size_t k) {
        return hn::Sub(hn::Load(f, leaf.corner[ray.axis[k]] + i * lanes), o[k]);
      };
      t.part[i] = hn::Mul(corner(2), all(ray.inverse_z));
      x.part[i] = hn::NegMulAdd(all(ray.direction_x), t.part[i], corner(0));
      y.part[i] = hn::NegMulAdd(all(ray.direction_y), t.part[i], corner(1));
    }
    for (std::size_t i = 0; i < leaf_steps; ++i) {
      const auto nibble = hn::Set(ids, leaf_corners - 1);
      const auto packed =
          hn::PromoteTo(ids, hn::Load(hn::Rebind<std::uint16_t, F>(), leaf.index + i * lanes));
      const auto a = hn::And(packed, nibble), b = hn::And(hn::ShiftRight<4>(packed), nibble),
                 c = hn::ShiftRight<8>(packed);
      const V x0 = x.at(a), x1 = x.at(b), x2 = x.at(c), y0 = y.at(a), y1 = y.at(b), y2 = y.at(c);
      const V u = hn::NegMulAdd(y2, x1, hn::Mul(x2, y1)), v = hn::NegMulAdd(y0, x2, hn::Mul(x0, y2)),
              w = hn::NegMulAdd(y1, x0, hn::Mul(x1, y0));
      const V least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
      const V det = hn::Add(hn::Add(u, v), w), size_of_det = hn::Abs(det);
      const V sum = hn::MulAdd(u, t.at(a), hn::MulAdd(v, t.at(b), hn::Mul(w, t.at(c))));
      const V depth = hn::Xor(sum, hn::And(det, all(-0.0f)));
      const auto met = hn::Or(hn::Ge(least, hn::Neg(error)), hn::Le(most, error));
      const auto in_range = hn::And(hn::Ge(depth, hn::MulSub(all(ray.t_min), size_of_det, depth_error)),
                                    hn::Le(depth, hn::MulAdd(all(ray.t_max), size_of_det, depth_error)));
      const unsigned left =
          (leaf.lanes >> i * lanes) & bits_of(f, hn::And(met, in_range)) & ((1u << lanes) - 1);
      if (left == 0) continue;
      candidates |= left << i * lanes;
      const V surely = hn::Mul(all(3.0f), error);
      const auto far_of = [](V p, V q, V r) { return hn::Max(hn::Max(hn::Abs(p), hn::Abs(q)), hn::Abs(r)); };
      const auto is_sure =
          hn::And(hn::Or(hn::Gt(least, surely), hn::Lt(most, hn::Neg(surely))),
                  hn::Le(hn::Max(far_of(x0, x1, x2), far_of(y0, y1, y2)), all(0.25f * leaf.size_13)));
      sure |= (left & bits_of(f, is_sure)) << i * lanes;
      const V per_det = hn::Div(all(1.0f), size_of_det), middle = hn::Mul(depth, per_det);
      const V wider = hn::MulAdd(hn::Abs(middle), all(0x1p-20f), hn::Mul(depth_error, per_det));
      hn::Store(hn::IfThenElse(is_sure, hn::Sub(middle, wider), all(-inf)), f, t_below + i * lanes);
      hn::Store(hn::Add(middle, wider), f, t_above + i * lanes);
    }
    for (unsigned shapes = leaf.shapes; shapes != 0; shapes &= shapes - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(shapes));
      t_below[i] = -inf;
    }
    candidates |= leaf.shapes;
  }
  bool is_sure(unsigned i) const { return (sure >> i & 1u) != 0; }
};

/// Asks memory ahead of need for a child that comes after the next one.
HWY_INLINE void prefetch(const WideNode* nodes, const WideLeaf* leaves, WideChild child) {
  const char* bytes = child.is_leaf() ? reinterpret_cast<const char*>(leaves + child.index())
                                      : reinterpret_cast<const char*>(nodes + child.index());
  constexpr std::size_t line = 64;
  static_assert(sizeof(WideNode) == 8 * line && sizeof(WideLeaf) == 4 * line);
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
      const float t = test.t_below[i];
      if (t > ray.t_max) return false;
      if (test.is_sure(i) && t > ray.surely_after) ray.limit(test.t_above[i]);
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
      if (test.is_sure(i) && test.t_below[i] > ray.surely_after && test.t_above[i] < ray.surely_before)
        return true;
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
