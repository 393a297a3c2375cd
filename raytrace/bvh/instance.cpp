#include "raytrace/bvh/instance.h"

#include <algorithm>
#include <cfloat>

#include "raytrace/bvh/treelet.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

using binned::Box;
using binned::set_child;

Box box_of(const BvhNode& node, std::size_t i) {
  Box box = Box::empty();
  for (std::size_t a = 0; a < 3; ++a) box.min[a] = node.bounds[a][i], box.max[a] = node.bounds[3 + a][i];
  return box;
}

Box around(const BvhNode& node) {
  Box box = Box::empty();
  for (std::size_t i = 0; i < 4; ++i) box.grow(box_of(node, i));
  return box;
}

/// Children that are not there become points: empty boxes are infinite, and infinity times zero is no number.
void close_up(Bvh& tree) {
  for (BvhNode& node : tree.nodes)
    for (std::size_t i = 0; i < 4; ++i)
      if (node.child[i].bits == BvhChild::empty().bits)
        for (auto& row : node.bounds) row[i] = 0.0f;
}

/// Four float roundings of the sums in place_node and three of their terms, and in double those of the offset and
/// of the world's own corners (scene/world.h).
constexpr double float_margin = 0x1p-20, double_margin = 0x1p-47;

/// All but the tree and its leaves' place.
void place(const WorldPart& part, const Bvh& tree, const Vec3& center, BvhInstance& out) {
  out.first_triangle = part.first_triangle, out.world_from_object = part.world_from_object;
  const Vec3 offset = placed_vertex(part.world_from_object, tree.center) - center;
  const Box reach = around(tree.nodes[0]);
  for (int r = 0; r < 3; ++r) {
    const auto row = static_cast<std::size_t>(r);
    double near = std::abs(offset[r]), far = std::abs(part.world_from_object[3][r]) + std::abs(center[r]),
           sum = 0.0;
    for (int c = 0; c < 3; ++c) {
      const auto column = static_cast<std::size_t>(c);
      const double m = part.world_from_object[c][r];
      const double half = std::max(std::abs(reach.min[column]), std::abs(reach.max[column]));
      out.matrix[row][column] = static_cast<float>(m);
      out.low_row[row][column] = static_cast<std::uint8_t>(out.matrix[row][column] < 0.0f ? 3 + c : c);
      near += std::abs(m) * half, far += std::abs(m) * (std::abs(tree.center[c]) + half), sum += half;
    }
    const double margin = float_margin * near + double_margin * far + FLT_MIN * (1.0 + sum);
    out.low_offset[row] = float_below(offset[r] - margin),
    out.high_offset[row] = float_above(offset[r] + margin);
  }
}

/// The nodes above the instances, appended to those of what is flattened.
class Upper {
 public:
  Upper(Bvh& bvh, std::vector<BoxRef> boxes)
      : bvh_(bvh), boxes_(std::move(boxes)), tree_(build_bvh(boxes_)) {}

  void run() {
    const bool alone = bvh_.nodes.empty();
    if (!alone) {  // a root above both trees
      const Box flat = around(bvh_.nodes[0]);
      const std::uint32_t moved = append(bvh_.nodes[0]);
      bvh_.below[moved] = bvh_.below[0];
      BvhNode& root = bvh_.nodes[0];
      for (std::size_t i = 2; i < 4; ++i) set_child(root, i, Box::empty(), BvhChild::empty());
      set_child(root, 0, flat, BvhChild::node(moved));
      set_child(root, 1, around(tree_.nodes[0]), BvhChild::empty());
      bvh_.below[0] = no_run;
    }
    const std::uint32_t top = copy(0);
    if (!alone) bvh_.nodes[0].child[1] = BvhChild::node(top);
  }

 private:
  /// More than packets take at once, so that they go on to the children.
  static constexpr LeafRange no_run{0, 0xffffffffu};

  std::uint32_t append(const BvhNode& node) {
    const auto index = static_cast<std::uint32_t>(bvh_.nodes.size());
    const BvhNode copied = node;
    bvh_.nodes.push_back(copied), bvh_.below.push_back(no_run);
    return index;
  }

  std::uint32_t copy(std::uint32_t from) {
    const std::uint32_t index = append(tree_.nodes[from]);
    for (std::size_t i = 0; i < 4; ++i) {
      const BvhChild child = tree_.nodes[from].child[i];
      if (child.bits == BvhChild::empty().bits) continue;
      const BvhChild now = child.is_leaf()
                               ? instances(std::span(tree_.ids).subspan(child.first(), child.count()))
                               : BvhChild::node(copy(child.index()));
      bvh_.nodes[index].child[i] = now;
    }
    return index;
  }

  /// One of them, or a node above up to four equal parts of them.
  BvhChild instances(std::span<const std::uint32_t> ids) {
    if (ids.size() == 1) return BvhChild::instance(ids[0]);
    const std::uint32_t index = append(BvhNode{});
    const std::size_t parts = std::min<std::size_t>(4, ids.size());
    for (std::size_t i = 0; i < 4; ++i) {
      if (i >= parts) {
        set_child(bvh_.nodes[index], i, Box::empty(), BvhChild::empty());
        continue;
      }
      const std::size_t first = i * ids.size() / parts, end = (i + 1) * ids.size() / parts;
      Box box = Box::empty();
      for (std::size_t k = first; k < end; ++k) {
        const BoxRef& ref = boxes_[ids[k]];
        for (std::size_t a = 0; a < 3; ++a)
          box.min[a] = std::min(box.min[a], ref.min[a]), box.max[a] = std::max(box.max[a], ref.max[a]);
      }
      const BvhChild child = instances(ids.subspan(first, end - first));
      set_child(bvh_.nodes[index], i, box, child);
    }
    return BvhChild::node(index);
  }

  Bvh& bvh_;
  std::vector<BoxRef> boxes_;  // of the instances, by their numbers
  Bvh tree_;
};

BoxRef box_around(const Aabb& bounds, const Vec3& center, std::uint32_t id) {
  BoxRef box{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    box.min[a] = float_below(bounds.min[axis] - center[axis]);
    box.max[a] = float_above(bounds.max[axis] - center[axis]);
  }
  box.id = id;
  return box;
}

}  // namespace

void add_instances(const World& world, Bvh& bvh) {
  std::vector<std::uint32_t> tree_of(world.scene->meshes.size(), no_id), leaves{0};
  std::vector<BoxRef> boxes;
  std::vector<const WorldPart*> placed;
  for (const WorldPart& part : world.parts) {
    if (!part.kept()) continue;
    std::uint32_t& tree = tree_of[static_cast<std::size_t>(part.mesh - world.scene->meshes.data())];
    if (tree == no_id) {
      tree = static_cast<std::uint32_t>(bvh.trees.size());
      bvh.trees.push_back(build_bvh(make_world(*world.scene, *part.mesh)));
      close_up(bvh.trees.back());
    }
    bvh.dropped += bvh.trees[tree].dropped;
    if (bvh.trees[tree].nodes.empty()) continue;
    BvhInstance instance{};
    instance.tree = tree, instance.first_leaf = static_cast<std::uint32_t>(bvh.ids.size()) + leaves.back();
    boxes.push_back(box_around(part.bounds, bvh.center, static_cast<std::uint32_t>(bvh.instances.size())));
    leaves.push_back(leaves.back() + static_cast<std::uint32_t>(bvh.trees[tree].ids.size()));
    bvh.instances.push_back(instance), placed.push_back(&part);
  }
  parallel_for(placed.size(), 256, [&](std::size_t i) {
    place(*placed[i], bvh.trees[bvh.instances[i].tree], bvh.center, bvh.instances[i]);
  });
  leave_if_given_up();
  bvh.instance_leaves = Ranges(std::move(leaves));
  if (!boxes.empty()) Upper(bvh, std::move(boxes)).run();
}

std::uint32_t Bvh::placed_id(std::uint32_t leaf) const {
  const BvhInstance& instance = instance_of(leaf);
  return instance.first_triangle + trees[instance.tree].ids[leaf - instance.first_leaf];
}

LeafPrimitive Bvh::placed_primitive(std::uint32_t leaf) const {
  const BvhInstance& instance = instance_of(leaf);
  const LeafPrimitive there = trees[instance.tree].primitives[leaf - instance.first_leaf];
  LeafPrimitive out;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 p = placed_vertex(instance.world_from_object, there.corner(k));
    out.v[3 * k] = p.x, out.v[3 * k + 1] = p.y, out.v[3 * k + 2] = p.z;
  }
  return out;
}

}  // namespace gnomon::raytrace
