// The upper part of the hierarchy: the primitives are sorted into the cells of a grid. The cells' runs are
// split by bins (Wald 2007) as if each run were one primitive of its weight. Ranges that have become
// small enough are split primitive by primitive (raytrace/bvh/treelet.h). Where a few cells hold many
// primitives, these get a finer grid of their own.
#include "raytrace/bvh/bvh.h"

#include "raytrace/bvh/clusters.h"
#include "raytrace/bvh/instance.h"
#include "raytrace/bvh/treelet.h"
#include "scene/base/parallel.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {
namespace {

using namespace binned;

using Config = BuildConfig;

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

/// A shape's numbers count as three vertices behind the triangles'.
void read_primitives(const World& world, Bvh& bvh) {
  const std::uint32_t triangles = world.triangle_count(), vertices = world.vertex_count();
  const auto vertices_of = [&](std::size_t leaf, std::span<std::array<std::uint32_t, 3>> out) {
    for (auto& corners : out) {
      const std::uint32_t id = bvh.ids[leaf++], first = vertices + 3 * (id - triangles);
      corners = id < triangles ? world.triangle(id) : std::array{first, first + 1, first + 2};
    }
  };
  const auto position_of = [&](const std::uint32_t* vertex, std::span<Vec3> out) {
    for (Vec3& position : out) {
      const std::uint32_t v = *vertex++, number = v - vertices;
      position =
          v < vertices ? world.position(v) : leaf_primitive(world, triangles + number / 3).corner(number % 3);
    }
  };
  bvh.primitives = LeafPrimitives(bvh.ids.size(), {vertices_of, position_of});
}

Box centroids_of(std::span<const Ref> refs) {
  NodeBounds bounds;
  for (const Ref& ref : refs) bounds.grow_centroids(ref);
  return bounds.centroids;
}

/// A range of clusters, and where their primitives begin in the order of the leaves.
struct ClusterRange {
  std::uint32_t first_cluster, clusters, first, count;
  NodeBounds bounds;
  int depth;  // in binary splits
  bool is_whole = false;
};

/// Nodes of fewer than four children have more than leaf_size primitives and leaves alone: those of treelets
/// are fewer than 7/15 of the primitives. The ranges of one depth above are apart, each of more than
/// Config::treelet_size.
std::size_t most_nodes(std::size_t primitives) {
  static_assert(Config::sah_depth * 5 <= Config::treelet_size);
  return 7 * primitives / 15 + primitives / 5 + 2;
}

class Builder {
 public:
  Builder(Bvh& bvh, std::size_t count) : bvh_(bvh), nodes_(bvh, most_nodes(count)) { bvh.ids.resize(count); }

  void run(std::span<const BoxRef> boxes) {
    const BvhChild root = build(boxes, centroid_bounds(boxes), 0, 0);
    if (root.is_leaf()) {
      const std::uint32_t index = nodes_.take(1);
      BvhNode& node = nodes_[index];
      nodes_.below(index) = {root.first(), root.count()};
      Box box = Box::empty();
      for (const BoxRef& b : boxes) box.grow(ref_of(b).box);
      set_child(node, 0, box, root);
      for (std::size_t i = 1; i < 4; ++i) set_child(node, i, Box::empty(), BvhChild::empty());
    }
    nodes_.finish();
  }

 private:
  template <class In>
  friend class Top;

  template <class In>
  BvhChild build(std::span<const In> in, const Box& centroids, std::uint32_t first, int depth);

  BvhChild treelet(TreeletScratch& scratch, std::uint32_t first, int depth) {
    const BvhChild root = build_treelet(scratch, first, depth, nodes_);
    for (std::size_t i = 0; i < scratch.refs.size(); ++i) bvh_.ids[first + i] = scratch.refs[i].id();
    return root;
  }

  Bvh& bvh_;
  NodeStore nodes_;
  PerThread<TreeletScratch> scratches_;
};

/// The part of the tree above the runs of one grid over some boxes.
template <class In>
class Top {
 public:
  Top(Builder& builder, std::span<const In> in, Clusters& grid)
      : builder_(builder), in_(in), grid_(grid), scratch_(grid.size()) {}

  BvhChild run(std::uint32_t first, int depth) {
    ClusterRange all{0,     static_cast<std::uint32_t>(grid_.size()),
                     first, static_cast<std::uint32_t>(in_.size()),
                     {},    depth};
    for (const Ref& box : grid_.boxes) all.bounds.grow(box);
    return node(all, 2);
  }

 private:
  BvhChild build(const ClusterRange& range) {
    if (range.count <= Config::treelet_size || range.depth >= Config::sah_depth) {
      TreeletScratch& scratch = builder_.scratches_.local();
      gather(range, scratch.refs);
      return builder_.treelet(scratch, range.first, range.depth);
    }
    if (range.clusters >= Config::few_clusters) return node(range, Config::few_clusters);
    std::vector<Ref> refs;
    gather(range, refs);
    return builder_.build<Ref>(refs, centroids_of(refs), range.first, range.depth);
  }

  void gather(const ClusterRange& range, std::vector<Ref>& refs) const {
    refs.resize(range.count);
    auto at = refs.begin();
    for (std::uint32_t i = 0; i < range.clusters; ++i) {
      const Cluster& cluster = cluster_at(range.first_cluster + i);
      for (std::uint32_t k = 0; k < cluster.count; ++k) *at++ = as_ref(in_[grid_.order[cluster.first + k]]);
    }
  }
  const Cluster& cluster_at(std::uint32_t i) const { return grid_.clusters[grid_.boxes[i].id()]; }

  /// `least`: clusters in a range that may be split.
  BvhChild node(const ClusterRange& range, std::uint32_t least) {
    std::array<ClusterRange, 4> children{range};
    const std::size_t count = split_into_four(children, [&](const ClusterRange& child) {
      return child.clusters >= least ? std::optional(split(child)) : std::nullopt;
    });
    const std::uint32_t index = builder_.nodes_.take(1);
    builder_.nodes_.below(index) = {range.first, range.count};
    const auto store_child = [&](std::size_t i) {
      BvhNode& node = builder_.nodes_[index];
      if (i < count)
        set_child(node, i, children[i].bounds.box, build(children[i]));
      else
        set_child(node, i, Box::empty(), BvhChild::empty());
    };
    if (range.count < Config::parallel_threshold)
      for (std::size_t i = 0; i < 4; ++i) store_child(i);
    else
      parallel_tasks(4, store_child);
    leave_if_given_up();
    return BvhChild::node(index);
  }

  // Reorders the range's clusters, of which there are at least two.
  std::array<ClusterRange, 2> split(const ClusterRange& range) {
    const std::span<Ref> boxes(grid_.boxes.data() + range.first_cluster, range.clusters);
    const Binning binning(range.bounds.centroids, most_bins, 0.0f);
    const Bins bins =
        fill_bins(boxes, binning, [&](const Ref& box) { return grid_.clusters[box.id()].count; });
    const Split best = find_best_split(bins, binning);
    std::array<NodeBounds, 2> bounds;
    std::uint32_t middle = fallback_split(range);
    if (best.bin >= 0)
      middle = partition(boxes, scratch_.data() + range.first_cluster, bounds,
                         [&](const Ref& box) { return binning.is_left(box, best); });
    bounds = {};
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < range.clusters; ++i) {
      bounds[i < middle ? 0 : 1].grow(boxes[i]);
      if (i < middle) count += grid_.clusters[boxes[i].id()].count;
    }
    const int depth = range.depth + 1;
    return {{{range.first_cluster, middle, range.first, count, bounds[0], depth},
             {range.first_cluster + middle, range.clusters - middle, range.first + count, range.count - count,
              bounds[1], depth}}};
  }

  // Where no bins tell the clusters apart: half of them to each side, in the order of the grid.
  static std::uint32_t fallback_split(const ClusterRange& range) { return range.clusters / 2; }

  Builder& builder_;
  std::span<const In> in_;
  Clusters& grid_;
  std::vector<Ref> scratch_;
};

template <class In>
BvhChild Builder::build(std::span<const In> in, const Box& centroids, std::uint32_t first, int depth) {
  if (in.size() > Config::treelet_size && depth < Config::sah_depth && grid_applies(centroids)) {
    Clusters grid = cluster_by_cells(in, centroids);
    return Top<In>(*this, in, grid).run(first, depth);
  }
  TreeletScratch& scratch = scratches_.local();
  scratch.refs.resize(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) scratch.refs[i] = as_ref(in[i]);
  return treelet(scratch, first, depth);
}

}  // namespace

Bvh build_bvh(const World& world) {
  FinitePrimitives finite = flattened_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  if (!finite.boxes.empty()) Builder(bvh, finite.boxes.size()).run(finite.boxes);
  finite.boxes = {};  // before more memory is asked for
  read_primitives(world, bvh);
  if (world.keeps_instances()) add_instances(world, bvh);
  return bvh;
}

Bvh build_bvh(std::span<const BoxRef> boxes) {
  Bvh bvh;
  if (!boxes.empty()) Builder(bvh, boxes.size()).run(boxes);
  return bvh;
}

Bvh build_flat(const World& world) {
  const FinitePrimitives finite = finite_primitives(world);
  Bvh bvh;
  bvh.dropped = finite.dropped;
  bvh.center = finite.center;
  bvh.ids.resize(finite.boxes.size());
  for (std::size_t i = 0; i < finite.boxes.size(); ++i) bvh.ids[i] = finite.boxes[i].id;
  read_primitives(world, bvh);
  return bvh;
}

}  // namespace gnomon::raytrace
