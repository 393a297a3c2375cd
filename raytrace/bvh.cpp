#include "raytrace/bvh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <limits>
#include <numeric>

#include "raytrace/bvh_bins.h"
#include "raytrace/packet/huge_array.h"
#include "scene/solid.h"

namespace gnomon::raytrace {
namespace {

using namespace binned;

constexpr std::size_t few_primitives = 64;
constexpr std::uint32_t max_leaf_size = 4;
constexpr std::uint32_t parallel_threshold = 4096;  // primitives; below it a task costs more than it gains
constexpr std::uint32_t parallel_scan = 1u << 16;   // so with a scan over a range
constexpr float traversal_cost = 1.0f;              // of a box pair, in triangle tests
constexpr int sah_depth =
    44;  // deeper than this, split at the median: at most 32 more levels (Bvh::max_depth)

struct BinaryNode {
  Box box;
  std::uint32_t first, count;  // count > 0: leaf
  std::uint32_t right;         // the left child follows its parent
};

class Builder {
 public:
  explicit Builder(std::span<const BoxRef> boxes)
      : count_(boxes.size()), refs_(boxes.size()), scratch_(boxes.size()), nodes_(2 * boxes.size()) {
    tbb::parallel_for(std::size_t{0}, count_, [&](std::size_t i) { refs_[i] = ref_of(boxes[i]); });
    build_range(0, 0, static_cast<std::uint32_t>(count_), 0);
  }
  const HugeArray<BinaryNode>& nodes() const { return nodes_; }
  std::uint32_t id(std::size_t i) const { return refs_[i].id(); }

 private:
  // A subtree of n primitives owns the 2n - 1 node places from `node` on, so that threads never share a
  // counter.
  void build_range(std::uint32_t node, std::uint32_t first, std::uint32_t count, int depth) {
    const std::span<Ref> refs(refs_.data() + first, count);
    BinaryNode& out = nodes_[node];
    const Bounds bounds = scan<Bounds>(
        refs, [] { return Bounds{}; }, [](Bounds& b, const Ref& ref) { b.grow(ref); },
        [](Bounds& a, const Bounds& b) { a.grow(b); });
    out.box = bounds.box, out.count = 0;
    const std::uint32_t left = split(refs, bounds, depth);
    if (left == 0) {
      out.first = first, out.count = count;
      return;
    }
    out.right = node + 2 * left;
    const auto build_left = [&] { build_range(node + 1, first, left, depth + 1); };
    const auto build_right = [&] { build_range(node + 2 * left, first + left, count - left, depth + 1); };
    if (count < parallel_threshold)
      build_left(), build_right();
    else
      tbb::parallel_invoke(build_left, build_right);
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

  // Reorders refs and returns how many go left; 0: make a leaf.
  std::uint32_t split(std::span<Ref> refs, const Bounds& bounds, int depth) {
    const auto count = static_cast<std::uint32_t>(refs.size());
    if (count <= 1) return 0;
    const std::size_t used = count < few_primitives ? few_bins : most_bins;
    const Binning binning(bounds.centroids, used);
    Split best;
    if (depth < sah_depth) {
      const Bins bins = scan<Bins>(
          refs, [used] { return Bins(used); }, [&](Bins& b, const Ref& ref) { b.put(ref, binning(ref)); },
          [used](Bins& a, const Bins& b) { a.join(b, used); });
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (binning.scale[axis] > 0.0f) best_on_axis(bins, used, axis, best);
    }
    const float area = bounds.box.half_area();
    const bool split_pays =
        best.bin >= 0 && best.cost + traversal_cost * area < area * static_cast<float>(count);
    if (count <= max_leaf_size && !split_pays) return 0;
    if (best.bin < 0) return median(refs, bounds.centroids);
    return partition(refs, [&](const Ref& ref) { return binning(ref)[best.axis] <= best.bin; });
  }

  // Keeps the order on both sides.
  template <class GoesLeft>
  std::uint32_t partition(std::span<Ref> refs, const GoesLeft& goes_left) {
    Ref* scratch = scratch_.data() + (refs.data() - refs_.data());
    std::size_t left = 0, right = 0;
    for (std::size_t i = 0; i < refs.size(); ++i) {
      const Ref ref = refs[i];
      const std::size_t is_left = goes_left(ref) ? 1 : 0;
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

  std::size_t count_;
  HugeArray<Ref> refs_, scratch_;
  HugeArray<BinaryNode> nodes_;
};

// Folds a binary node and its largest descendants into up to four children.
class Folder {
 public:
  Folder(const HugeArray<BinaryNode>& binary, HugeVector<BvhNode>& out) : binary_(binary), out_(out) {
    out_.reserve(binary.size() / 5 + 16);  // usually enough
  }

  std::uint32_t fold(std::uint32_t root) {
    std::array<std::uint32_t, 4> children{root};
    std::size_t count = 1;
    while (count < 4 && open_largest(children, count)) {
    }
    const auto index = static_cast<std::uint32_t>(out_.size());
    out_.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      const Box box = i < count ? binary_[children[i]].box : Box::empty();
      for (std::size_t a = 0; a < 3; ++a)
        out_[index].bounds[a][i] = box.min[a], out_[index].bounds[3 + a][i] = box.max[a];
      out_[index].child[i] = BvhChild::empty();
      if (i >= count) continue;
      const BinaryNode& node = binary_[children[i]];
      const BvhChild child =
          node.count > 0 ? BvhChild::leaf(node.first, node.count) : BvhChild::node(fold(children[i]));
      out_[index].child[i] = child;
    }
    return index;
  }

 private:
  bool open_largest(std::array<std::uint32_t, 4>& children, std::size_t& count) const {
    std::size_t largest = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (binary_[children[i]].count > 0) continue;
      if (largest == count || area(children[i]) > area(children[largest])) largest = i;
    }
    if (largest == count) return false;
    const std::uint32_t opened = children[largest];
    children[largest] = opened + 1;
    children[count++] = binary_[opened].right;
    return true;
  }
  float area(std::uint32_t node) const { return binary_[node].box.half_area(); }

  const HugeArray<BinaryNode>& binary_;
  HugeVector<BvhNode>& out_;
};

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

// In blocks over all threads, joined in the order of ids.
void append_triangles(const World& world, FinitePrimitives& out) {
  constexpr std::uint32_t block_size = 8192;
  std::vector<std::vector<BoxRef>> blocks((world.triangle_count() + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    const auto first = static_cast<std::uint32_t>(block) * block_size;
    const std::uint32_t end = std::min(first + block_size, world.triangle_count());
    blocks[block].reserve(end - first);
    for (std::uint32_t id = first; id < end; ++id)
      if (usable_triangle(world, id)) blocks[block].push_back(triangle_box(world, id, out.center));
  });
  for (const std::vector<BoxRef>& block : blocks)
    out.boxes.insert(out.boxes.end(), block.begin(), block.end());
  out.dropped += world.triangle_count() - out.boxes.size();
}

}  // namespace

FinitePrimitives finite_primitives(const World& world) {
  FinitePrimitives out;
  out.boxes.reserve(world.triangle_count());
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
  const Builder builder(finite.boxes);
  tbb::parallel_invoke(
      [&] {
        Folder(builder.nodes(), bvh.nodes).fold(0);
        bvh.nodes.shrink_to_fit();
      },
      [&] {
        fill_leaves(
            world, finite.boxes.size(), [&](std::size_t i) { return builder.id(i); }, bvh);
      });
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
