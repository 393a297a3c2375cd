#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/bvh/wide_traverse.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/bvh/wide_instances.h"
#include "raytrace/bvh/wide_node-inl.h"
#include "raytrace/bvh/wide_ray-inl.h"
#include "raytrace/bvh/wide_traverse.h"
#include "raytrace/tracer.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

template <class Leaf>
const Leaf* leaves_of(const WideTree& tree) {
  if constexpr (std::is_same_v<Leaf, PlainLeaf>)
    return tree.plain_leaves.data();
  else
    return tree.leaves.data();
}

/// Asks memory ahead of need for a child that comes after the next one.
template <class Leaf>
HWY_INLINE void prefetch(const WideNode* nodes, const Leaf* leaves, WideChild child) {
  constexpr std::size_t line = 64;
  const auto lines = [](const void* at, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += line) __builtin_prefetch(static_cast<const char*>(at) + i);
  };
  if (child.is_leaf())
    lines(leaves + child.index(), sizeof(Leaf));
  else
    lines(nodes + child.index(), sizeof(WideNode));
}

/// What a traversal tests: nothing is counted, or the boxes of a node's children and the triangles of a leaf.
struct NoCounts {
  void node(const WideNode&) const {}
  void leaf(const LeafTriangles&) const {}
};
struct CountTests {
  WorkCounts& work;
  void node(const WideNode& node) const {
    for (std::size_t i = 0; i < node_lanes; ++i) work.boxes += node.bounds[0][i] <= node.bounds[3][i] ? 1 : 0;
  }
  void leaf(const LeafTriangles& triangles) const { work.primitives += triangles.last() + 1; }
};

/// intersect(leaf) returns true to end the traversal.
template <class Leaf, class Intersect, class Counts>
HWY_INLINE WideTraversal traverse(const WideTree& tree, WideRay& ray, const Counts& counts,
                                  const Intersect& intersect) {
  const SpreadRay spread(ray);
  const WideNode* nodes = tree.nodes.data();
  const Leaf* leaves = leaves_of<Leaf>(tree);
  float t_max = ray.t_max;
  Stack stack;
  std::size_t size = 0;
  std::size_t known = 0;  // on the stack, asked for already
  const auto ask_ahead = [&] {
    if (size > known) prefetch(nodes, leaves, WideChild{stack.child[size - 1]});
    known = size;
  };
  WideChild child{0};
  for (;;) {
    if (child.is_leaf()) {
      counts.leaf(leaves[child.index()].triangles);
      if (intersect(leaves[child.index()])) return WideTraversal::ended;
      t_max = ray.t_max;
    } else if (size > 0 && !WideChild{stack.child[size - 1]}.is_leaf() && stack.near[size - 1] <= t_max) {
      known = 0;
      const WideNode& after = nodes[stack.child[--size]];
      counts.node(nodes[child.index()]), counts.node(after);
      if (take_children_of_two(nodes[child.index()], after, spread, t_max, stack, size, child.bits)) {
        ask_ahead();
        continue;
      }
    } else {
      const WideNode& node = nodes[child.index()];
      counts.node(node);
      if (IntersectedChildren<>(node, spread, t_max).take(node, spread, stack, size, child.bits)) {
        ask_ahead();
        continue;
      }
    }
    do {
      if (size == 0) return WideTraversal::done;
      child.bits = stack.child[--size];
    } while (stack.near[size] > t_max);
    known = 0;
    ask_ahead();
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

constexpr auto all_wanted = [](unsigned candidates) { return candidates; };

/// candidate(i, test) for each; true ends.
template <class Test, class Candidate, class Wanted = decltype(all_wanted)>
HWY_INLINE bool each_candidate(const typename Test::Leaf& leaf, const WideRay& ray,
                               const Candidate& candidate, const Wanted& wanted = all_wanted) {
  const Test test(leaf, ray, wanted);
  for (unsigned left = test.candidates; left != 0; left &= left - 1)
    if (candidate(static_cast<unsigned>(std::countr_zero(left)), test)) return true;
  return false;
}

template <class Test>
bool is_surely_hit(unsigned i, const Test& test, const WideRay& ray) {
  return test.is_sure(i) && ray.surely_starts_before(test.t_below(i)) &&
         ray.surely_ends_after(test.t_above(i));
}

template <class Test, class Counts>
HWY_INLINE WideTraversal closest(const WideTree& tree, WideRay& ray, LeafCandidates& found,
                                 const Counts& counts) {
  const LeafPrimitives& primitives = tree.origin->primitives;
  const auto traversed =
      traverse<typename Test::Leaf>(tree, ray, counts, [&](const typename Test::Leaf& leaf) {
        primitives.prefetch_leaf(leaf.triangles.first(), leaf.triangles.last() + 1);
        return each_candidate<Test>(leaf, ray, [&](unsigned i, const Test& test) {
          const float t = test.t_below(i);
          if (t > ray.t_max) return false;
          if (test.is_sure(i) && ray.surely_starts_before(t)) ray.limit(test.t_above(i));
          tree.origin->prefetch(leaf.triangles.first() + i);
          return !keep(found, leaf.triangles.first() + i, t, ray);
        });
      });
  found.t_max = ray.t_max;
  return traversed == WideTraversal::ended ? WideTraversal::refused : traversed;
}

template <class Test, class Counts>
HWY_INLINE WideTraversal visit_all(const WideTree& tree, WideRay& ray, const CandidateVisitor& visit,
                                   const Counts& counts) {
  return traverse<typename Test::Leaf>(tree, ray, counts, [&](const typename Test::Leaf& leaf) {
    return each_candidate<Test>(
        leaf, ray, [&](unsigned i, const Test&) { return visit(leaf.triangles.first() + i, ray); });
  });
}

template <class Test, class Counts>
HWY_INLINE WideTraversal visit_ambiguous_hits(const WideTree& tree, WideRay& ray,
                                              const CandidateVisitor& visit, const Counts& counts) {
  return traverse<typename Test::Leaf>(tree, ray, counts, [&](const typename Test::Leaf& leaf) {
    return each_candidate<Test>(leaf, ray, [&](unsigned i, const Test& test) {
      if (is_surely_hit(i, test, ray)) return true;
      return visit(leaf.triangles.first() + i, ray);
    });
  });
}

template <class Counts>
HWY_INLINE WideTraversal closest_of(const WideTree& tree, const Ray& given, LeafCandidates& found,
                                    const Counts& counts) {
  WideRay ray;
  if (!prepare(tree, given, {}, ray)) return WideTraversal::refused;
  return tree.plain ? closest<PlainTest>(tree, ray, found, counts)
                    : closest<LeafTest>(tree, ray, found, counts);
}

template <class Counts>
HWY_INLINE WideTraversal visit_of(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                                  const CandidateVisitor& visit, const Counts& counts) {
  WideRay ray;
  if (!prepare(tree, given, limits, ray)) return WideTraversal::refused;
  return tree.plain ? visit_all<PlainTest>(tree, ray, visit, counts)
                    : visit_all<LeafTest>(tree, ray, visit, counts);
}

template <class Counts>
HWY_INLINE WideTraversal ambiguous_of(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                                      const CandidateVisitor& visit, const Counts& counts) {
  WideRay ray;
  if (!prepare(tree, given, limits, ray)) return WideTraversal::refused;
  return tree.plain ? visit_ambiguous_hits<PlainTest>(tree, ray, visit, counts)
                    : visit_ambiguous_hits<LeafTest>(tree, ray, visit, counts);
}

WideTraversal closest_kernel(const WideTree& tree, const Ray& ray, LeafCandidates& found) {
  return closest_of(tree, ray, found, NoCounts{});
}
WideTraversal closest_counted(const WideTree& tree, const Ray& ray, LeafCandidates& found, WorkCounts& work) {
  return closest_of(tree, ray, found, CountTests{work});
}

WideTraversal visit_kernel(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                           CandidateVisitor visit) {
  return visit_of(tree, ray, limits, visit, NoCounts{});
}
WideTraversal visit_counted(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                            CandidateVisitor visit, WorkCounts& work) {
  return visit_of(tree, ray, limits, visit, CountTests{work});
}

WideTraversal collect_kernel(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                             std::uint32_t skip, LeafCandidates& found) {
  WideRay ray;
  if (!prepare(tree, given, limits, ray)) return WideTraversal::refused;
  bool full = false;
  const auto traversed = traverse<WideLeaf>(tree, ray, NoCounts{}, [&](const WideLeaf& leaf) {
    const auto others = [&](unsigned candidates) {
      for (unsigned left = candidates; left != 0; left &= left - 1)
        if (tree.origin->ids[leaf.triangles.first() + static_cast<unsigned>(std::countr_zero(left))] == skip)
          candidates &= ~(left & -left);
      return candidates;
    };
    const auto keep_ambiguous = [&](unsigned i, const LeafTest& test) {
      if (is_surely_hit(i, test, ray)) return true;
      full = !keep(found, leaf.triangles.first() + i, test.t_below(i), ray);
      return full;
    };
    return each_candidate<LeafTest>(leaf, ray, keep_ambiguous, others);
  });
  return full ? WideTraversal::refused : traversed;
}

WideTraversal ambiguous_kernel(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                               CandidateVisitor visit) {
  return ambiguous_of(tree, ray, limits, visit, NoCounts{});
}
WideTraversal ambiguous_counted(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                CandidateVisitor visit, WorkCounts& work) {
  return ambiguous_of(tree, ray, limits, visit, CountTests{work});
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(closest_kernel);
HWY_EXPORT(closest_counted);
HWY_EXPORT(visit_kernel);
HWY_EXPORT(visit_counted);
HWY_EXPORT(ambiguous_kernel);
HWY_EXPORT(ambiguous_counted);
HWY_EXPORT(collect_kernel);

namespace {

/// Asked for once: Highway's own function lies in a library, and a ray is too short for such a call.
const hwy::ChosenTarget& chosen = hwy::GetChosenTarget();

}  // namespace

// What HWY_DYNAMIC_DISPATCH says, but for that.
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
#define GNOMON_KERNEL(name) HWY_STATIC_DISPATCH(name)
#else
#define GNOMON_KERNEL(name) (*HWY_DISPATCH_TABLE(name)[chosen.GetIndex()])
#endif

WideTraversal visit_in_tree(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                            CandidateVisitor visit, WorkCounts* work) {
  return work != nullptr ? GNOMON_KERNEL(visit_counted)(tree, ray, limits, visit, *work)
                         : GNOMON_KERNEL(visit_kernel)(tree, ray, limits, visit);
}
WideTraversal visit_ambiguous_in_tree(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                      CandidateVisitor visit, WorkCounts* work) {
  return work != nullptr ? GNOMON_KERNEL(ambiguous_counted)(tree, ray, limits, visit, *work)
                         : GNOMON_KERNEL(ambiguous_kernel)(tree, ray, limits, visit);
}
WideTraversal ambiguous_in_tree(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                std::uint32_t skip, LeafCandidates& found) {
  return GNOMON_KERNEL(collect_kernel)(tree, ray, limits, skip, found);
}

WideTraversal closest_candidates(const WideTree& tree, const Ray& ray, LeafCandidates& found,
                                 WorkCounts* work) {
  if (!tree.instances.empty()) return WideTraversal::refused;
  return work != nullptr ? GNOMON_KERNEL(closest_counted)(tree, ray, found, *work)
                         : GNOMON_KERNEL(closest_kernel)(tree, ray, found);
}
WideTraversal visit_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                               CandidateVisitor visit, WorkCounts* work) {
  return tree.instances.empty() ? visit_in_tree(tree, ray, limits, visit, work)
                                : visit_in_instances(tree, ray, limits, visit, work);
}
WideTraversal visit_ambiguous(const WideTree& tree, const Ray& ray, CandidateVisitor visit,
                              WorkCounts* work) {
  return tree.instances.empty() ? visit_ambiguous_in_tree(tree, ray, {}, visit, work)
                                : visit_ambiguous_in_instances(tree, ray, visit, work);
}
WideTraversal ambiguous_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                   std::uint32_t skip, LeafCandidates& found) {
  return tree.instances.empty() ? ambiguous_in_tree(tree, ray, limits, skip, found)
                                : ambiguous_in_instances(tree, ray, limits, skip, found);
}

#undef GNOMON_KERNEL

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
