#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/bvh/treelet.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/bvh/treelet.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::binned::HWY_NAMESPACE {
namespace {

using Config = BuildConfig;
constexpr std::uint32_t few = Config::sorted_size;

/// A range of primitives, to be split further or not.
struct Range {
  std::uint32_t first, count;
  NodeBounds bounds;  // of few, the box alone
  int depth;          // in binary splits
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
    const Binning steps(bounds, 1u << 11, Config::flat);
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

/// The cheaper one of `best` and the cheapest cut along the axis.
Cut best_on_axis(std::span<const Ref> refs, const Order& order, std::size_t axis, Cut best) {
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
  return best;
}

Cut find_best_cut(std::span<const Ref> refs, const Order& order) {
  Cut best;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (order.is_apart(axis)) best = best_on_axis(refs, order, axis, best);
  return best;
}

class Treelet {
 public:
  Treelet(TreeletScratch& scratch, std::uint32_t first)
      : scratch_(scratch), refs_(scratch.refs), first_(first) {}

  BvhChild run(int depth) {
    Range all{0, static_cast<std::uint32_t>(refs_.size()), {}, depth};
    for (const Ref& ref : refs_) all.bounds.grow(ref);
    return build(all);
  }

 private:
  BvhChild build(const Range& range) {
    std::array<Range, 4> children{range};
    const std::size_t count = split_into_four(children, [&](const Range& child) { return split(child); });
    if (count == 1) return leaf(range);
    const auto index = static_cast<std::uint32_t>(scratch_.nodes.size());
    scratch_.nodes.emplace_back(), scratch_.below.push_back({first_ + range.first, range.count});
    for (std::size_t i = 0; i < 4; ++i) {
      const Box box = i < count ? children[i].bounds.box : Box::empty();
      const BvhChild child = i >= count             ? BvhChild::empty()
                             : children[i].is_whole ? leaf(children[i])
                                                    : build(children[i]);
      set_child(scratch_.nodes[index], i, box, child);
    }
    return BvhChild::node(index);
  }
  BvhChild leaf(const Range& range) const { return BvhChild::leaf(first_ + range.first, range.count); }

  // Reorders the range's primitives; nothing: it is to become a leaf.
  std::optional<std::array<Range, 2>> split(const Range& range) {
    if (range.count <= Config::leaf_size) return std::nullopt;
    const std::span<Ref> refs = refs_.subspan(range.first, range.count);
    std::array<NodeBounds, 2> bounds;
    std::uint32_t middle = 0;
    if (range.depth >= Config::sah_depth)
      middle = fallback_split(refs, range, bounds);
    else
      middle = range.count <= few ? split_sorted(refs, range, bounds) : split_binned(refs, range, bounds);
    const int depth = range.depth + 1;
    return std::array<Range, 2>{{{range.first, middle, bounds[0], depth},
                                 {range.first + middle, range.count - middle, bounds[1], depth}}};
  }

  // These return how many go left.
  std::uint32_t split_sorted(std::span<Ref> refs, const Range& range, std::array<NodeBounds, 2>& bounds) {
    const Order order(refs);
    const Cut best = find_best_cut(refs, order);
    if (best.left == 0) return fallback_split(refs, range, bounds);
    Ref sorted[few];
    for (std::size_t i = 0; i < refs.size(); ++i) sorted[i] = refs[order(best.axis, i)];
    for (std::size_t i = 0; i < refs.size(); ++i) {
      refs[i] = sorted[i];
      bounds[i < best.left ? 0 : 1].box.grow(sorted[i].box);
    }
    return static_cast<std::uint32_t>(best.left);
  }

  std::uint32_t split_binned(std::span<Ref> refs, const Range& range, std::array<NodeBounds, 2>& bounds) {
    const Binning binning(range.bounds.centroids, Config::few_bins, Config::flat);
    const Bins bins = fill_bins(refs, binning, [](const Ref&) { return 1u; });
    const Split best = find_best_split(bins, binning);
    if (best.bin < 0) return fallback_split(refs, range, bounds);
    const std::array<Box, 2> boxes = boxes_of(bins, binning.count, best);
    bounds[0].box = boxes[0], bounds[1].box = boxes[1];
    return partition(refs, scratch_.moved.data(), bounds,
                     [&](const Ref& ref) { return binning.is_left(ref, best); });
  }

  // Half to each side by (centroid along the widest axis, id): defined even when all centroids are equal.
  std::uint32_t fallback_split(std::span<Ref> refs, const Range& range, std::array<NodeBounds, 2>& bounds) {
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

  TreeletScratch& scratch_;
  std::span<Ref> refs_;
  std::uint32_t first_;
};

BvhChild treelet_kernel(TreeletScratch& scratch, std::uint32_t first, int depth) {
  return Treelet(scratch, first).run(depth);
}

}  // namespace
}  // namespace gnomon::raytrace::binned::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace::binned {
HWY_EXPORT(treelet_kernel);

BvhChild build_treelet(TreeletScratch& scratch, std::uint32_t first, int depth, NodeStore& store) {
  scratch.moved.resize(std::max(scratch.moved.size(), scratch.refs.size()));
  scratch.nodes.clear(), scratch.below.clear();
  const BvhChild root = HWY_DYNAMIC_DISPATCH(treelet_kernel)(scratch, first, depth);
  if (root.is_leaf()) return root;
  const std::uint32_t base = store.take(static_cast<std::uint32_t>(scratch.nodes.size()));
  for (std::uint32_t i = 0; i < scratch.nodes.size(); ++i) {
    BvhNode node = scratch.nodes[i];
    for (BvhChild& child : node.child)
      if (!child.is_leaf()) child = BvhChild::node(base + child.index());
    store[base + i] = node, store.below(base + i) = scratch.below[i];
  }
  return BvhChild::node(base);
}

}  // namespace gnomon::raytrace::binned
#endif  // HWY_ONCE
