#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/bvh/treelet.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/bvh/treelet.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::binned::HWY_NAMESPACE {
namespace {

// So many are a leaf without asking what a split would gain: half the nodes, and rays are no slower for it.
constexpr std::uint32_t leaf_size = 4;
constexpr std::uint32_t few = 16;  // sorted instead of binned
constexpr float flat = 0.5f;       // an axis as flat as this is hardly ever the best for a treelet

/// A range of primitives, to be split further or not.
struct Range {
  std::uint32_t first, count;
  Bounds bounds;  // of few, the box alone
  int depth;      // in binary splits
  bool is_whole = false;
};

/// At most `few` primitives in the order of their centroids along each axis.
class Order {
 public:
  explicit Order(std::span<const Ref> refs) : count_(refs.size()) {
    Box bounds = Box::empty();
    Row centroid[few];
    for (std::size_t i = 0; i < count_; ++i) {
      centroid[i] = refs[i].centroid2();
      lower(bounds.min, centroid[i]), raise(bounds.max, centroid[i]);
    }
    const Binning steps(bounds, 1u << 11, flat);
    for (std::size_t a = 0; a < 3; ++a) apart_[a] = steps.scale[a] > 0.0f;
    std::fill_n(&key_[0][0], 3 * few, INT16_MAX);
    for (std::size_t i = 0; i < count_; ++i) {
      alignas(16) std::int32_t step[4];
      store_truncated(
          min_keep((centroid[i].all() - steps.origin.all()) * steps.scale.all(), Float4::all(2047.0f)), step);
      for (std::size_t a = 0; a < 3; ++a)
        key_[a][i] = static_cast<std::int16_t>(step[a] << 4 | static_cast<int>(i));
    }
    for (std::size_t a = 0; a < 3; ++a)
      if (apart_[a]) count_ <= 8 ? sort<8>(a) : sort<few>(a);
  }
  /// Whether the axis tells them apart well enough to be tried.
  bool is_apart(std::size_t axis) const { return apart_[axis]; }
  std::size_t operator()(std::size_t axis, std::size_t rank) const { return order_[axis][rank]; }

 private:
  // The keys are different: a key's rank is the number of lesser ones.
  template <std::size_t width>
  void sort(std::size_t axis) {
    const std::int16_t* key = key_[axis];
    alignas(16) std::int16_t rank[width] = {};
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t k = 0; k < width; ++k)
        rank[k] = static_cast<std::int16_t>(rank[k] + (key[i] < key[k] ? 1 : 0));
    for (std::size_t i = 0; i < count_; ++i) order_[axis][rank[i]] = static_cast<std::uint8_t>(i);
  }

  std::size_t count_;
  std::array<bool, 3> apart_;
  alignas(16) std::int16_t key_[3][few];
  std::uint8_t order_[3][few];
};

/// The boxes' extents, and from four of them at once half their surface.
class Areas {
 public:
  void put(std::size_t i, const Box& box) { extent_[i] = box.max.all() - box.min.all(); }
  void store(std::size_t four, float* half_area) {
    Float4* e = extent_ + four;
    Float4 rows[4] = {e[0], e[1], e[2], e[3]};
    transpose(rows);
    (rows[0] * rows[1] + rows[1] * rows[2] + rows[2] * rows[0]).store(half_area + four);
  }

 private:
  Float4 extent_[few] = {};
};

/// The cheapest way to cut the sorted row in two, by the surface-area heuristic.
struct Cut {
  std::size_t axis = 0, left = 0;  // how many go left; 0: none found
  float cost = std::numeric_limits<float>::infinity();
};

void cut_axis(std::span<const Ref> refs, const Order& order, std::size_t axis, Cut& best) {
  const std::size_t count = refs.size();
  Areas left, right;
  Box below = Box::empty(), above = Box::empty();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    below.grow(refs[order(axis, i)].box), left.put(i, below);
    above.grow(refs[order(axis, count - 1 - i)].box), right.put(count - 2 - i, above);
  }
  alignas(16) float left_area[few], right_area[few];
  for (std::size_t i = 0; i + 1 < count; i += 4) left.store(i, left_area), right.store(i, right_area);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const float cost =
        left_area[i] * static_cast<float>(i + 1) + right_area[i] * static_cast<float>(count - i - 1);
    if (cost < best.cost) best = {axis, i + 1, cost};
  }
}

class Treelet {
 public:
  Treelet(TreeletRoom& room, std::uint32_t first) : room_(room), refs_(room.refs), first_(first) {}

  BvhChild run(int depth) {
    Range all{0, static_cast<std::uint32_t>(refs_.size()), {}, depth};
    for (const Ref& ref : refs_) all.bounds.grow(ref);
    return build(all);
  }

 private:
  BvhChild build(const Range& range) {
    std::array<Range, 4> children{range};
    const std::size_t count =
        four_of(children, [&](Range& left, Range& right) { return split(left, right); });
    if (count == 1) return leaf(range);
    const auto index = static_cast<std::uint32_t>(room_.nodes.size());
    room_.nodes.emplace_back(), room_.below.push_back({first_ + range.first, range.count});
    for (std::size_t i = 0; i < 4; ++i) {
      const Box box = i < count ? children[i].bounds.box : Box::empty();
      const BvhChild child = i >= count             ? BvhChild::empty()
                             : children[i].is_whole ? leaf(children[i])
                                                    : build(children[i]);
      set_child(room_.nodes[index], i, box, child);
    }
    return BvhChild::node(index);
  }
  BvhChild leaf(const Range& range) const { return BvhChild::leaf(first_ + range.first, range.count); }

  // Reorders the range's primitives and leaves it the left ones; false: make a leaf.
  bool split(Range& left, Range& right) {
    if (left.count <= leaf_size) return false;
    const std::span<Ref> refs = refs_.subspan(left.first, left.count);
    std::array<Bounds, 2> bounds;
    std::uint32_t middle = 0;
    if (left.depth >= sah_depth)
      middle = halve(refs, left, bounds);
    else
      middle = left.count <= few ? cut(refs, left, bounds) : bin(refs, left, bounds);
    right = {left.first + middle, left.count - middle, bounds[1], left.depth + 1};
    left = {left.first, middle, bounds[0], left.depth + 1};
    return true;
  }

  // These return how many go left.
  std::uint32_t cut(std::span<Ref> refs, const Range& range, std::array<Bounds, 2>& bounds) {
    const Order order(refs);
    Cut best;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (order.is_apart(axis)) cut_axis(refs, order, axis, best);
    if (best.left == 0) return halve(refs, range, bounds);
    Ref sorted[few];
    for (std::size_t i = 0; i < refs.size(); ++i) sorted[i] = refs[order(best.axis, i)];
    for (std::size_t i = 0; i < refs.size(); ++i) {
      refs[i] = sorted[i];
      bounds[i < best.left ? 0 : 1].box.grow(sorted[i].box);
    }
    return static_cast<std::uint32_t>(best.left);
  }

  std::uint32_t bin(std::span<Ref> refs, const Range& range, std::array<Bounds, 2>& bounds) {
    constexpr std::size_t used = few_bins;
    const Binning binning(range.bounds.centroids, used, flat);
    Bins bins(binning);
    for (const Ref& ref : refs) bins.put(ref, binning);
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (binning.scale[axis] > 0.0f) best_on_axis(bins, used, axis, best);
    if (best.bin < 0) return halve(refs, range, bounds);
    const std::array<Box, 2> boxes = boxes_of(bins, used, best);
    bounds[0].box = boxes[0], bounds[1].box = boxes[1];
    return partition(refs, room_.scratch.data(), bounds,
                     [&](const Ref& ref) { return binning.is_left(ref, best); });
  }

  // By (centroid along the widest axis, id): defined even when all centroids are equal.
  std::uint32_t halve(std::span<Ref> refs, const Range& range, std::array<Bounds, 2>& bounds) {
    const Box& centroids = range.bounds.centroids;
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (centroids.max[a] - centroids.min[a] > centroids.max[axis] - centroids.min[axis]) axis = a;
    const std::size_t half = refs.size() / 2;
    std::nth_element(refs.begin(), refs.begin() + static_cast<std::ptrdiff_t>(half), refs.end(),
                     [axis](const Ref& a, const Ref& b) {
                       const float ca = a.centroid2()[axis], cb = b.centroid2()[axis];
                       return ca != cb ? ca < cb : a.id() < b.id();
                     });
    for (std::size_t i = 0; i < refs.size(); ++i) bounds[i < half ? 0 : 1].grow(refs[i]);
    return static_cast<std::uint32_t>(half);
  }

  TreeletRoom& room_;
  std::span<Ref> refs_;
  std::uint32_t first_;
};

BvhChild treelet_kernel(TreeletRoom& room, std::uint32_t first, int depth) {
  return Treelet(room, first).run(depth);
}

}  // namespace
}  // namespace gnomon::raytrace::binned::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace::binned {
HWY_EXPORT(treelet_kernel);

BvhChild build_treelet(TreeletRoom& room, std::uint32_t first, int depth, NodeStore& store) {
  room.scratch.resize(std::max(room.scratch.size(), room.refs.size()));
  room.nodes.clear(), room.below.clear();
  const BvhChild root = HWY_DYNAMIC_DISPATCH(treelet_kernel)(room, first, depth);
  if (root.is_leaf()) return root;
  const std::uint32_t base = store.take(static_cast<std::uint32_t>(room.nodes.size()));
  for (std::uint32_t i = 0; i < room.nodes.size(); ++i) {
    BvhNode node = room.nodes[i];
    for (BvhChild& child : node.child)
      if (!child.is_leaf()) child = BvhChild::node(base + child.index());
    store[base + i] = node, store.below(base + i) = room.below[i];
  }
  return BvhChild::node(base);
}

}  // namespace gnomon::raytrace::binned
#endif  // HWY_ONCE
