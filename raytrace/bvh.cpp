#include "raytrace/bvh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <limits>
#include <numeric>

#include "scene/solid.h"

namespace gnomon::raytrace {
namespace {

constexpr int bin_count = 16;
constexpr std::uint32_t max_leaf_size = 4;
constexpr std::uint32_t parallel_threshold = 4096;  // primitives; below it a task costs more than it gains
constexpr float traversal_cost = 1.0f;              // of a box pair, in triangle tests
constexpr int sah_depth =
    44;  // deeper than this, split at the median: at most 32 more levels (Bvh::max_depth)

struct Box {
  std::array<float, 3> min, max;
  static Box empty() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return {{inf, inf, inf}, {-inf, -inf, -inf}};
  }
  template <class B>
  void grow(const B& b) {
    for (std::size_t a = 0; a < 3; ++a)
      min[a] = std::min(min[a], b.min[a]), max[a] = std::max(max[a], b.max[a]);
  }
  float half_area() const {
    const float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
  }
};

struct BinaryNode {
  Box box;
  std::uint32_t first = 0, count = 0;  // count > 0: leaf
  std::uint32_t right = 0;             // the left child follows its parent
};

// Twice the centroid: halving would only lose the smallest numbers.
float centroid2(const BoxRef& ref, std::size_t axis) {
  return ref.min[axis] + ref.max[axis];
}

struct Split {
  std::size_t axis = 0;
  int bin = -1;  // primitives of bins <= bin go left; -1: none found
  float cost = std::numeric_limits<float>::infinity();
};

struct Binning {
  float origin, scale;
  int operator()(const BoxRef& ref, std::size_t axis) const {
    const float b = (centroid2(ref, axis) - origin) * scale;
    return b < 0.0f ? 0
                    : std::min(bin_count - 1, static_cast<int>(std::min(b, static_cast<float>(bin_count))));
  }
};

// An axis without extent (or too wide for a float) cannot be binned: scale 0.
Binning binning(const Box& centroids, std::size_t axis) {
  const float extent = centroids.max[axis] - centroids.min[axis];
  const float scale = extent > 0.0f ? bin_count / extent : 0.0f;
  return {centroids.min[axis], std::isfinite(scale) && std::isfinite(extent) ? scale : 0.0f};
}

void best_on_axis(std::span<const BoxRef> refs, const Binning& bins, std::size_t axis, Split& best) {
  std::array<Box, bin_count> boxes;
  std::array<std::uint32_t, bin_count> counts{};
  boxes.fill(Box::empty());
  for (const BoxRef& ref : refs) {
    const auto b = static_cast<std::size_t>(bins(ref, axis));
    boxes[b].grow(ref);
    ++counts[b];
  }
  std::array<float, bin_count> right_cost{};
  Box box = Box::empty();
  std::uint32_t count = 0;
  for (std::size_t b = bin_count - 1; b > 0; --b) {
    box.grow(boxes[b]), count += counts[b];
    right_cost[b - 1] =
        count == 0 ? std::numeric_limits<float>::infinity() : box.half_area() * static_cast<float>(count);
  }
  box = Box::empty(), count = 0;
  for (std::size_t b = 0; b + 1 < bin_count; ++b) {
    box.grow(boxes[b]), count += counts[b];
    if (count == 0) continue;
    const float cost = box.half_area() * static_cast<float>(count) + right_cost[b];
    if (cost < best.cost) best = {axis, static_cast<int>(b), cost};
  }
}

class Builder {
 public:
  Builder(std::vector<BoxRef>& refs) : refs_(refs), nodes_(std::max<std::size_t>(1, 2 * refs.size())) {}

  std::vector<BinaryNode>& build() {
    build_range(0, 0, static_cast<std::uint32_t>(refs_.size()), 0);
    return nodes_;
  }

 private:
  // A subtree of n primitives owns the 2n - 1 node places from `node` on, so that threads never share a
  // counter.
  void build_range(std::uint32_t node, std::uint32_t first, std::uint32_t count, int depth) {
    const std::span<BoxRef> refs(refs_.data() + first, count);
    BinaryNode& out = nodes_[node];
    Box centroids = Box::empty();
    out.box = Box::empty();
    for (const BoxRef& ref : refs) {
      out.box.grow(ref);
      for (std::size_t a = 0; a < 3; ++a) {
        centroids.min[a] = std::min(centroids.min[a], centroid2(ref, a));
        centroids.max[a] = std::max(centroids.max[a], centroid2(ref, a));
      }
    }
    const std::uint32_t left = split(refs, out.box, centroids, depth);
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

  // Reorders refs and returns how many go left; 0: make a leaf.
  static std::uint32_t split(std::span<BoxRef> refs, const Box& box, const Box& centroids, int depth) {
    const auto count = static_cast<std::uint32_t>(refs.size());
    if (count <= 1) return 0;
    Split best;
    for (std::size_t axis = 0; axis < 3 && depth < sah_depth; ++axis) {
      const Binning bins = binning(centroids, axis);
      if (bins.scale > 0.0f) best_on_axis(refs, bins, axis, best);
    }
    const float leaf_cost = box.half_area() * static_cast<float>(count);
    const bool split_pays = best.bin >= 0 && best.cost + traversal_cost * box.half_area() < leaf_cost;
    if (count <= max_leaf_size && !split_pays) return 0;
    if (best.bin < 0) return median(refs, centroids);
    const Binning bins = binning(centroids, best.axis);
    const auto middle = std::stable_partition(
        refs.begin(), refs.end(), [&](const BoxRef& r) { return bins(r, best.axis) <= best.bin; });
    return static_cast<std::uint32_t>(middle - refs.begin());
  }

  // Halves by (centroid along the widest axis, id): defined even when all centroids are equal.
  static std::uint32_t median(std::span<BoxRef> refs, const Box& centroids) {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (centroids.max[a] - centroids.min[a] > centroids.max[axis] - centroids.min[axis]) axis = a;
    const auto middle = refs.begin() + static_cast<std::ptrdiff_t>(refs.size() / 2);
    std::nth_element(refs.begin(), middle, refs.end(), [axis](const BoxRef& a, const BoxRef& b) {
      const float ca = centroid2(a, axis), cb = centroid2(b, axis);
      return ca != cb ? ca < cb : a.id < b.id;
    });
    return static_cast<std::uint32_t>(refs.size() / 2);
  }

  std::vector<BoxRef>& refs_;
  std::vector<BinaryNode> nodes_;
};

// Folds a binary node and its largest descendants into up to four children.
class Folder {
 public:
  Folder(const std::vector<BinaryNode>& binary, std::vector<BvhNode>& out) : binary_(binary), out_(out) {}

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

  const std::vector<BinaryNode>& binary_;
  std::vector<BvhNode>& out_;
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

void fill_leaves(const World& world, std::span<const BoxRef> refs, Bvh& bvh) {
  bvh.primitives.resize(refs.size());
  bvh.ids.resize(refs.size());
  tbb::parallel_for(std::size_t{0}, refs.size(), [&](std::size_t i) {
    bvh.ids[i] = refs[i].id;
    bvh.primitives[i] = leaf_primitive(world, refs[i].id);
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
  FinitePrimitives finite = finite_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  if (finite.boxes.empty()) return bvh;
  const std::vector<BinaryNode> binary = std::move(Builder(finite.boxes).build());
  Folder(binary, bvh.nodes).fold(0);
  bvh.nodes.shrink_to_fit();
  fill_leaves(world, finite.boxes, bvh);
  return bvh;
}

Bvh build_flat(const World& world) {
  const FinitePrimitives finite = finite_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  fill_leaves(world, finite.boxes, bvh);
  return bvh;
}

}  // namespace gnomon::raytrace
