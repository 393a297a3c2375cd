#include "raytrace/bvh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <atomic>
#include <numeric>

#include "raytrace/bvh_bins.h"
#include "raytrace/packet/huge_array.h"
#include "scene/solid.h"

namespace gnomon::raytrace {
namespace {

using namespace binned;

constexpr std::size_t few_primitives = 64;
constexpr std::uint32_t max_leaf_size = 4, small_leaf_size = 2;  // small: never split
constexpr std::uint32_t parallel_threshold = 4096;  // primitives; below it a task costs more than it gains
constexpr std::uint32_t parallel_scan = 1u << 16;   // so with a scan over a range
constexpr float traversal_cost = 1.0f;              // of a box pair, in triangle tests
constexpr int sah_depth =
    44;  // deeper than this, split at the median: at most 32 more levels (Bvh::max_depth)

/// A range of primitives, to be split further or not.
struct Range {
  std::uint32_t first, count;
  Bounds bounds;
  int depth;             // in binary splits
  bool is_leaf = false;  // known not to be split
};

// Top down, a node of four children at once: the largest range is split until there are four (the tree is
// that of two children a node, folded). A thread takes a node's place when it begins it.
class Builder {
 public:
  explicit Builder(std::span<const BoxRef> boxes, HugeVector<BvhNode>& nodes)
      : refs_(boxes.size()), scratch_(boxes.size()), nodes_(nodes) {
    tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t i) { refs_[i] = ref_of(boxes[i]); });
    nodes_.resize(boxes.size());  // without values: pages that are not reached cost nothing
    Range all{0, static_cast<std::uint32_t>(boxes.size()), {}, 0};
    all.bounds = bounds_of({refs_.data(), boxes.size()});
    const BvhChild root = build(all);
    if (root.is_leaf()) all.is_leaf = true, put_node(all.count, {&all, 1});
    nodes_.resize(used_);
  }
  std::uint32_t id(std::size_t i) const { return refs_[i].id(); }

 private:
  BvhChild build(const Range& range) {
    std::array<Range, 4> children{range};
    std::size_t count = 1;
    while (count < 4 && split_largest(children, count)) {
    }
    return count == 1 ? BvhChild::leaf(range.first, range.count)
                      : BvhChild::node(put_node(range.count, {children.data(), count}));
  }

  std::uint32_t put_node(std::uint32_t primitives, std::span<const Range> children) {
    const std::uint32_t index = used_++;
    BvhNode& node = nodes_[index];
    for (std::size_t i = 0; i < 4; ++i) {
      const Box box = i < children.size() ? children[i].bounds.box : Box::empty();
      for (std::size_t a = 0; a < 3; ++a) node.bounds[a][i] = box.min[a], node.bounds[3 + a][i] = box.max[a];
      node.child[i] = BvhChild::empty();
    }
    const auto put_child = [&](std::size_t i) {
      const Range& child = children[i];
      node.child[i] = child.is_leaf ? BvhChild::leaf(child.first, child.count) : build(child);
    };
    if (primitives < parallel_threshold)
      for (std::size_t i = 0; i < children.size(); ++i) put_child(i);
    else
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, children.size(), 1),
          [&](const auto& r) {
            for (std::size_t i = r.begin(); i != r.end(); ++i) put_child(i);
          },
          tbb::simple_partitioner());
    return index;
  }

  /// False when no range is left that can be split.
  static bool largest_open(std::span<const Range> children, std::size_t& largest) {
    largest = children.size();
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (children[i].is_leaf) continue;
      if (largest == children.size() ||
          children[i].bounds.box.half_area() > children[largest].bounds.box.half_area())
        largest = i;
    }
    return largest < children.size();
  }
  bool split_largest(std::array<Range, 4>& children, std::size_t& count) {
    for (std::size_t i = 0; largest_open({children.data(), count}, i);) {
      if (split(children[i], children[count])) {
        ++count;
        return true;
      }
      children[i].is_leaf = true;
    }
    return false;
  }

  /// add() over all of them, a large range over all threads. Joining is exact, so the parts do not matter.
  template <class Value, class Start, class Add, class Join>
  static Value scan(std::span<const Ref> refs, const Start& start, const Add& add, const Join& join) {
    const auto part = [&](std::size_t begin, std::size_t end, Value value) {
      for (std::size_t i = begin; i < end; ++i) add(value, refs[i]);
      return value;
    };
    if (refs.size() < parallel_scan) return part(0, refs.size(), start());
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, refs.size(), parallel_scan / 4), start(),
        [&](const auto& r, Value value) { return part(r.begin(), r.end(), std::move(value)); },
        [&](Value a, const Value& b) {
          join(a, b);
          return a;
        });
  }
  static Bounds bounds_of(std::span<const Ref> refs) {
    return scan<Bounds>(
        refs, [] { return Bounds{}; }, [](Bounds& b, const Ref& ref) { b.grow(ref); },
        [](Bounds& a, const Bounds& b) { a.grow(b); });
  }

  // Reorders the range's primitives and leaves it the left ones; false: make a leaf.
  bool split(Range& left, Range& right) {
    const std::uint32_t count = left.count;
    if (count <= small_leaf_size) return false;
    const std::span<Ref> refs(refs_.data() + left.first, count);
    const std::size_t used = count < few_primitives ? few_bins : most_bins;
    const Binning binning(left.bounds.centroids, used);
    Split best;
    std::array<Bounds, 2> bounds;
    if (left.depth < sah_depth) {
      const Bins bins = scan<Bins>(
          refs, [used] { return Bins(used); }, [&](Bins& b, const Ref& ref) { b.put(ref, binning); },
          [used](Bins& a, const Bins& b) { a.join(b, used); });
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (binning.scale[axis] > 0.0f) best_on_axis(bins, used, axis, best);
      const std::array<Box, 2> boxes = boxes_of(bins, used, best);
      bounds[0].box = boxes[0], bounds[1].box = boxes[1];
    }
    const float area = left.bounds.box.half_area();
    const bool split_pays =
        best.bin >= 0 && best.cost + traversal_cost * area < area * static_cast<float>(count);
    if (count <= max_leaf_size && !split_pays) return false;
    std::uint32_t middle = 0;
    if (best.bin >= 0) {
      middle = partition(refs, bounds, [&](const Ref& ref) { return binning.is_left(ref, best); });
    } else {
      middle = median(refs, left.bounds.centroids);
      bounds = {bounds_of(refs.first(middle)), bounds_of(refs.subspan(middle))};
    }
    right = {left.first + middle, count - middle, bounds[1], left.depth + 1};
    left = {left.first, middle, bounds[0], left.depth + 1};
    return true;
  }

  // Keeps the order on both sides, and finds the bounds of their centroids on the way.
  template <class GoesLeft>
  std::uint32_t partition(std::span<Ref> refs, std::array<Bounds, 2>& bounds, const GoesLeft& goes_left) {
    Ref* scratch = scratch_.data() + (refs.data() - refs_.data());
    std::size_t left = 0, right = 0;
    for (std::size_t i = 0; i < refs.size(); ++i) {
      const Ref ref = refs[i];
      const std::size_t is_left = goes_left(ref) ? 1 : 0;
      bounds[1 - is_left].grow_centroids(ref);
      refs[left] = ref, scratch[right] = ref;
      left += is_left, right += 1 - is_left;
    }
    std::copy(scratch, scratch + right, refs.begin() + static_cast<std::ptrdiff_t>(left));
    return static_cast<std::uint32_t>(left);
  }

  // Halves by (centroid along the widest axis, id): defined even when all centroids are equal.
  static std::uint32_t median(std::span<Ref> refs, const Box& centroids) {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (centroids.max[a] - centroids.min[a] > centroids.max[axis] - centroids.min[axis]) axis = a;
    const auto middle = refs.begin() + static_cast<std::ptrdiff_t>(refs.size() / 2);
    std::nth_element(refs.begin(), middle, refs.end(), [axis](const Ref& a, const Ref& b) {
      const float ca = a.centroid2()[axis], cb = b.centroid2()[axis];
      return ca != cb ? ca < cb : a.id() < b.id();
    });
    return static_cast<std::uint32_t>(refs.size() / 2);
  }

  HugeArray<Ref> refs_, scratch_;
  HugeVector<BvhNode>& nodes_;
  std::atomic<std::uint32_t> used_{0};
};

}  // namespace

LeafPrimitive leaf_primitive(const World& world, std::uint32_t id) {
  if (world.is_triangle(id)) {
    const auto [a, b, c] = world.corners(id);
    return {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}};
  }
  const ShapeGeometry& geometry = world.shape(id).geometry;
  if (is_solid(geometry)) return {};  // looked up in the world
  const auto& sphere = std::get<Sphere>(geometry);
  return {{sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius}};
}

namespace {

template <class IdAt>
void fill_leaves(const World& world, std::size_t count, const IdAt& id_at, Bvh& bvh) {
  bvh.primitives.resize(count);
  bvh.ids.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    bvh.ids[i] = id_at(i);
    bvh.primitives[i] = leaf_primitive(world, bvh.ids[i]);
  });
}

// A difference of doubles is right to 2^-53 of itself, far less than float_below and float_above give way.
BoxRef box_of(const Vec3& min, const Vec3& max, std::uint32_t id) {
  return {{float_below(min.x), float_below(min.y), float_below(min.z)},
          {float_above(max.x), float_above(max.y), float_above(max.z)},
          id};
}

BoxRef triangle_box(const World& world, std::uint32_t id, const Vec3& center) {
  const auto [a, b, c] = world.corners(id);
  return box_of(glm::min(a, glm::min(b, c)) - center, glm::max(a, glm::max(b, c)) - center, id);
}

BoxRef sphere_box(const Sphere& sphere, std::uint32_t id, const Vec3& center) {
  const Vec3 middle = sphere.center - center;
  const Vec3 half = Vec3(sphere.radius) + error_gamma(3) * (glm::abs(middle) + Vec3(sphere.radius));
  return box_of(middle - half, middle + half, id);
}

BoxRef solid_box(const ShapeGeometry& solid, std::uint32_t id, const Vec3& center) {
  const Aabb box = world_box(solid);
  const Vec3 error = error_gamma(32) * (glm::abs(box.min) + glm::abs(box.max) + box.extent());
  return box_of(box.min - error - center, box.max + error - center, id);
}

bool usable_triangle(const World& world, std::uint32_t id) {
  const auto [a, b, c] = world.corners(id);
  return all_finite(a) && all_finite(b) && all_finite(c) && geometric_normal(world, id, a) != Vec3(0.0);
}

// In blocks over all threads, each at the place of its ids; closed up where some were left out.
void append_triangles(const World& world, FinitePrimitives& out) {
  constexpr std::uint32_t block_size = 8192;
  const std::uint32_t count = world.triangle_count();
  std::vector<std::uint32_t> kept((count + block_size - 1) / block_size);
  out.boxes.resize(count);
  tbb::parallel_for(std::size_t{0}, kept.size(), [&](std::size_t block) {
    const auto first = static_cast<std::uint32_t>(block) * block_size;
    BoxRef* at = out.boxes.data() + first;
    for (std::uint32_t id = first; id < std::min(first + block_size, count); ++id)
      if (usable_triangle(world, id)) *at++ = triangle_box(world, id, out.center);
    kept[block] = static_cast<std::uint32_t>(at - out.boxes.data()) - first;
  });
  std::size_t size = 0;
  for (std::size_t block = 0; block < kept.size(); size += kept[block++])
    if (size != block * block_size)
      std::copy_n(out.boxes.data() + block * block_size, kept[block], out.boxes.data() + size);
  out.boxes.resize(size);
  out.dropped += count - size;
}

}  // namespace

FinitePrimitives finite_primitives(const World& world) {
  FinitePrimitives out;
  const Vec3 middle = world.finite_bounds.center();
  if (all_finite(middle)) out.center = middle;
  append_triangles(world, out);
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id) {
    const ShapeGeometry& geometry = world.shape(id).geometry;
    if (std::holds_alternative<Plane>(geometry)) continue;
    if (is_solid(geometry)) {
      const Aabb box = world_box(geometry);
      if (all_finite(box.min) && all_finite(box.max))
        out.boxes.push_back(solid_box(geometry, id, out.center));
      else
        ++out.dropped;
      continue;
    }
    const auto* sphere = std::get_if<Sphere>(&geometry);
    if (all_finite(sphere->center) && std::isfinite(sphere->radius) && sphere->radius > 0.0)
      out.boxes.push_back(sphere_box(*sphere, id, out.center));
    else
      ++out.dropped;
  }
  return out;
}

Bvh build_bvh(const World& world) {
  const FinitePrimitives finite = finite_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  if (finite.boxes.empty()) return bvh;
  const Builder builder(finite.boxes, bvh.nodes);
  fill_leaves(
      world, finite.boxes.size(), [&](std::size_t i) { return builder.id(i); }, bvh);
  return bvh;
}

Bvh build_bvh(std::span<const BoxRef> boxes) {
  Bvh bvh;
  if (boxes.empty()) return bvh;
  const Builder builder(boxes, bvh.nodes);
  bvh.ids.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) bvh.ids[i] = builder.id(i);
  return bvh;
}

Bvh build_flat(const World& world) {
  const FinitePrimitives finite = finite_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  fill_leaves(
      world, finite.boxes.size(), [&](std::size_t i) { return finite.boxes[i].id; }, bvh);
  return bvh;
}

}  // namespace gnomon::raytrace
