// The traversal of a block of tiles through the hierarchy (view_block.cpp, shadow_block.cpp): the nodes that the
// block's frustum touches, nearest first, down to runs of a few leaves.

#if defined(GNOMON_RAYTRACE_PACKETS_BLOCK_TRAVERSE_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_BLOCK_TRAVERSE_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_BLOCK_TRAVERSE_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_BLOCK_TRAVERSE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/bvh/instance.h"
#include "raytrace/packets/frustum-inl.h"
#include "raytrace/packets/projection-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

inline BoxRef box_of(const BvhNode& node, std::uint32_t child) {
  BoxRef box{};
  for (std::size_t a = 0; a < 3; ++a)
    box.min[a] = node.bounds[a][child], box.max[a] = node.bounds[3 + a][child];
  return box;
}

/// A tree's part of traverse_block: of nodes only those that wanted(box), enter(number) for every instance. `space`:
/// NodesThere or NodesPlaced.
template <class Space, class Limit, class Wanted, class Run, class Enter>
void traverse_tree_by_block(const Bvh& tree, const Space& space, const Frustum& frustum, const Limit& limit,
                            const Wanted& wanted, const Run& run, const Enter& enter) {
  struct Entry {
    const BvhNode* parent;
    std::uint32_t child;
    float priority;
  };
  constexpr std::size_t together = 4;
  Entry stack[together * Bvh::stack_size];
  std::size_t size = 0;
  std::uint32_t nodes[together] = {0};
  std::size_t count = 1;
  BvhNode scratch;
  while (count > 0) {
    for (std::size_t k = count; k-- > 0;) {  // the nearest last, on top of the stack
      const BvhNode& node = tree.nodes[nodes[k]];
      alignas(16) float priority[4];
      const std::size_t base = size;
      for (unsigned mask = frustum.hits(space.at(node, scratch), limit(), priority); mask != 0;
           mask &= mask - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(mask));
        if (!node.child[i].is_leaf()) {
          __builtin_prefetch(&tree.below[node.child[i].index()]);
          const char* next = reinterpret_cast<const char*>(&tree.nodes[node.child[i].index()]);
          __builtin_prefetch(next), __builtin_prefetch(next + 64);
        }
        std::size_t at = size++;
        for (; at > base && stack[at - 1].priority > priority[i]; --at) stack[at] = stack[at - 1];
        stack[at] = {&node, i, priority[i]};
      }
    }
    for (count = 0; size > 0 && count < together;) {
      const Entry entry = stack[--size];
      if (entry.priority < limit()) continue;
      const BvhChild child = entry.parent->child[entry.child];
      const LeafRange below =
          child.is_leaf() ? LeafRange{child.first(), child.count()} : tree.below[child.index()];
      if (below.count > run_size) {
        if (wanted(box_of(space.at(*entry.parent, scratch), entry.child))) nodes[count++] = child.index();
      } else if (child.is_instance()) {
        enter(child.instance());
      } else if (below.count > 0) {
        run(box_of(space.at(*entry.parent, scratch), entry.child), space.leaves(below));
      }
    }
  }
}

inline bool want_every_box(const BoxRef&) {
  return true;
}

/// run(box, leaves) for every run that the frustum touches at a priority of at least limit(). Nearest first, but
/// several nodes at a time: memory takes longer to bring a node than its test takes. Below a kept instance only the nodes
/// that wanted(box): to place their children costs more than to ask.
template <class Limit, class Wanted, class Run>
void traverse_block(const Bvh& bvh, const Frustum& frustum, const Limit& limit, const Wanted& wanted,
                    const Run& run) {
  traverse_tree_by_block(bvh, NodesThere{}, frustum, limit, want_every_box, run, [&](std::uint32_t number) {
    const BvhInstance& instance = bvh.instances[number];
    traverse_tree_by_block(bvh.trees[instance.tree], NodesPlaced{instance}, frustum, limit, wanted, run,
                           [](std::uint32_t) {});
  });
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
