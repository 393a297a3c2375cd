#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/bvh/wide_traverse.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/bvh/wide_traverse-inl.h"
#include "raytrace/bvh/wide_traverse.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// Forgets those beyond t_max where there is no room. False: there is none.
inline bool keep(LeafCandidates& found, std::uint32_t leaf, float t, float t_max) {
  if (found.count == LeafCandidates::most) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i)
      if (found.t[i] <= t_max) found.leaf[kept] = found.leaf[i], found.t[kept++] = found.t[i];
    found.count = kept;
    if (kept == LeafCandidates::most) return false;
  }
  found.leaf[found.count] = leaf, found.t[found.count++] = t;
  return true;
}
inline bool keep(LeafCandidates& found, std::uint32_t leaf) {
  return keep(found, leaf, -inf, FLT_MAX);
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

// What is done with the leaves that a ray comes to, by a test of their triangles in floats; true ends the traversal.

template <class AnyTest>
struct Closest {
  using Test = AnyTest;
  static constexpr Order order = Order::nearest_first;
  LeafCandidates& found;

  HWY_INLINE bool leaf(const WideTree& tree, const typename Test::Leaf& leaf, WideRay& ray,
                       const Place& place) const {
    const std::uint32_t first = leaf.triangles.first();
    tree.origin->primitives.prefetch_leaf(first, leaf.triangles.last() + 1);
    return each_candidate<Test>(leaf, ray, [&](unsigned i, const Test& test) {
      const float t = test.t_below(i);
      if (t > ray.t_max) return false;
      if (test.is_sure(i) && ray.surely_starts_before(t)) ray.limit_here(test.t_above(i));
      tree.origin->prefetch(first + i);
      return !keep(found, place.first_leaf + first + i, ray.given_below(t), ray.given_above(ray.t_max));
    });
  }
  bool plainly(std::uint32_t leaf, WideRay&) const { return !keep(found, leaf); }
};

template <class AnyTest>
struct VisitAll {
  using Test = AnyTest;
  static constexpr Order order = Order::nearest_first;
  const CandidateVisitor& visit;

  HWY_INLINE bool leaf(const WideTree&, const typename Test::Leaf& leaf, WideRay& ray,
                       const Place& place) const {
    const std::uint32_t first = place.first_leaf + leaf.triangles.first();
    return each_candidate<Test>(leaf, ray, [&](unsigned i, const Test&) { return visit(first + i, ray); });
  }
  bool plainly(std::uint32_t leaf, WideRay& ray) const { return visit(leaf, ray); }
};

template <class AnyTest>
struct VisitBlockers {
  using Test = AnyTest;
  static constexpr Order order = Order::any;
  const BlockerVisitor& visit;

  HWY_INLINE bool leaf(const WideTree&, const typename Test::Leaf& leaf, WideRay& ray,
                       const Place& place) const {
    const std::uint32_t first = place.first_leaf + leaf.triangles.first();
    return each_candidate<Test>(leaf, ray, [&](unsigned i, const Test& test) {
      return visit(first + i, is_surely_hit(i, test, ray));
    });
  }
  bool plainly(std::uint32_t leaf, WideRay&) const { return visit(leaf, false); }
};

template <class AnyTest>
struct KeepAmbiguous {
  using Test = AnyTest;
  static constexpr Order order = Order::any;
  const Bvh& world;
  std::uint32_t skip;  // another triangle's number wraps to one that an instance's mesh does not have
  LeafCandidates& found;
  LastBlocker& last;
  bool& full;

  HWY_INLINE bool leaf(const WideTree& tree, const typename Test::Leaf& leaf, WideRay& ray,
                       const Place& place) const {
    return candidates(tree, leaf, ray, place, [&](unsigned i, const Test& test) {
      if (!is_surely_hit(i, test, ray))
        return full = !keep(found, place.first_leaf + leaf.triangles.first() + i);
      last = {&leaf, place.instance};
      return true;
    });
  }
  /// Whether a triangle of the leaf is surely hit.
  bool is_blocked(const WideTree& tree, const typename Test::Leaf& leaf, const WideRay& ray,
                  const Place& place) const {
    return candidates(tree, leaf, ray, place,
                      [&](unsigned i, const Test& test) { return is_surely_hit(i, test, ray); });
  }
  bool plainly(std::uint32_t leaf, WideRay&) const {
    return world.id_at(leaf) != skip && (full = !keep(found, leaf));
  }

 private:
  template <class Candidate>
  HWY_INLINE bool candidates(const WideTree& tree, const typename Test::Leaf& leaf, const WideRay& ray,
                             const Place& place, const Candidate& candidate) const {
    const std::uint32_t first = leaf.triangles.first();
    const auto others = [&](unsigned candidates) {
      for (unsigned left = candidates; left != 0; left &= left - 1)
        if (tree.origin->ids[first + static_cast<unsigned>(std::countr_zero(left))] ==
            skip - place.first_triangle)
          candidates &= ~(left & -left);
      return candidates;
    };
    return each_candidate<Test>(leaf, ray, candidate, others);
  }
};

/// `ray`, `frame_t`: what prepare made of `given`, and returned.
template <class Verb, class Counts>
HWY_INLINE WideTraversal run_prepared(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                                      double frame_t, const Verb& verb, const Counts& counts, WideRay& ray) {
  if constexpr (std::is_same_v<typename Verb::Test, LeafTest>)
    if (!tree.instances.empty()) [[unlikely]]
      return traverse_instances(tree, given, limits, frame_t, ray, verb, counts);
  return traverse<Verb::order, typename Verb::Test::Leaf>(
      tree, ray, counts, [&](const auto& leaf) { return verb.leaf(tree, leaf, ray, Place{}); });
}

template <class Verb, class Counts>
HWY_INLINE WideTraversal run(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                             const Verb& verb, const Counts& counts, WideRay& ray) {
  const double frame_t = prepare(tree, numbers_of(given), limits, ray);
  return frame_t > 0.0 ? run_prepared(tree, given, limits, frame_t, verb, counts, ray)
                       : WideTraversal::refused;
}

template <template <class> class Verb, class Counts, class... With>
HWY_INLINE WideTraversal by_test(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                 const Counts& counts, WideRay& ready, With&... with) {
  return tree.plain ? run(tree, ray, limits, Verb<PlainTest>{with...}, counts, ready)
                    : run(tree, ray, limits, Verb<LeafTest>{with...}, counts, ready);
}

template <class Counts>
HWY_INLINE WideTraversal closest_of(const WideTree& tree, const Ray& given, LeafCandidates& found,
                                    const Counts& counts) {
  WideRay ray;
  if (by_test<Closest>(tree, given, {}, counts, ray, found) != WideTraversal::done)
    return WideTraversal::refused;
  found.t_max = ray.t_max;
  return WideTraversal::done;
}

WideTraversal closest_kernel(const WideTree& tree, const Ray& ray, LeafCandidates& found) {
  return closest_of(tree, ray, found, NoCounts{});
}
WideTraversal closest_counted(const WideTree& tree, const Ray& ray, LeafCandidates& found, WorkCounts& work) {
  return closest_of(tree, ray, found, CountTests{work});
}

WideTraversal visit_kernel(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                           CandidateVisitor visit) {
  WideRay ready;
  return by_test<VisitAll>(tree, ray, limits, NoCounts{}, ready, visit);
}
WideTraversal visit_counted(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                            CandidateVisitor visit, WorkCounts& work) {
  WideRay ready;
  return by_test<VisitAll>(tree, ray, limits, CountTests{work}, ready, visit);
}

WideTraversal blockers_kernel(const WideTree& tree, const Ray& ray, BlockerVisitor visit) {
  WideRay ready;
  return by_test<VisitBlockers>(tree, ray, {}, NoCounts{}, ready, visit);
}
WideTraversal blockers_counted(const WideTree& tree, const Ray& ray, BlockerVisitor visit, WorkCounts& work) {
  WideRay ready;
  return by_test<VisitBlockers>(tree, ray, {}, CountTests{work}, ready, visit);
}

/// Runs a ray that is not prepared, as run_prepared() does one that is.
template <class Verb>
HWY_INLINE bool is_blocked_again(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                                 double frame_t, const Verb& verb, const WideRay& ray) {
  const auto& [leaf, instance] = verb.last;
  if (leaf == nullptr) return false;
  if (instance == nullptr) return verb.is_blocked(tree, *leaf, ray, Place{});
  WideRay placed;
  return place_ray(*instance, given, limits, error_in_world(given.origin, limits.origin_error), frame_t, ray,
                   placed) &&
         verb.is_blocked(*instance->mesh, *leaf, placed, Place(*instance));
}

WideTraversal collect_kernel(const WideTree& tree, const Ray& given, const TraversalLimits& limits,
                             std::uint32_t skip, LeafCandidates& found, LastBlocker& last) {
  WideRay ray;
  const double frame_t = prepare(tree, numbers_of(given), limits, ray);
  if (!(frame_t > 0.0)) return WideTraversal::refused;
  bool full = false;
  const KeepAmbiguous<LeafTest> verb{*tree.origin, skip, found, last, full};
  if (is_blocked_again(tree, given, limits, frame_t, verb, ray)) return WideTraversal::ended;
  const auto traversed = run_prepared(tree, given, limits, frame_t, verb, NoCounts{}, ray);
  return full ? WideTraversal::refused : traversed;
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
HWY_EXPORT(blockers_kernel);
HWY_EXPORT(blockers_counted);
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

WideTraversal closest_candidates(const WideTree& tree, const Ray& ray, LeafCandidates& found,
                                 WorkCounts* work) {
  return work != nullptr ? GNOMON_KERNEL(closest_counted)(tree, ray, found, *work)
                         : GNOMON_KERNEL(closest_kernel)(tree, ray, found);
}
WideTraversal visit_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                               CandidateVisitor visit, WorkCounts* work) {
  return work != nullptr ? GNOMON_KERNEL(visit_counted)(tree, ray, limits, visit, *work)
                         : GNOMON_KERNEL(visit_kernel)(tree, ray, limits, visit);
}
WideTraversal visit_blockers(const WideTree& tree, const Ray& ray, BlockerVisitor visit, WorkCounts* work) {
  return work != nullptr ? GNOMON_KERNEL(blockers_counted)(tree, ray, visit, *work)
                         : GNOMON_KERNEL(blockers_kernel)(tree, ray, visit);
}
WideTraversal ambiguous_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                   std::uint32_t skip, LeafCandidates& found, LastBlocker* last) {
  LastBlocker none;
  return GNOMON_KERNEL(collect_kernel)(tree, ray, limits, skip, found, last != nullptr ? *last : none);
}

#undef GNOMON_KERNEL

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
