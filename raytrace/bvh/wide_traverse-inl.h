// One ray through the wide tree, node by node, and through the instances in it.

#if defined(GNOMON_RAYTRACE_BVH_WIDE_TRAVERSE_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_BVH_WIDE_TRAVERSE_INL_H_
#undef GNOMON_RAYTRACE_BVH_WIDE_TRAVERSE_INL_H_
#else
#define GNOMON_RAYTRACE_BVH_WIDE_TRAVERSE_INL_H_
#endif

#include "raytrace/bvh/wide_instances.h"
#include "raytrace/bvh/wide_node-inl.h"
#include "raytrace/bvh/wide_ray-inl.h"
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

/// Asks memory ahead of need for a child that comes after the next one; not for an instance.
template <class Leaf>
HWY_INLINE void prefetch(const WideNode* nodes, const Leaf* leaves, WideChild child) {
  constexpr std::size_t line = 64;
  const auto lines = [](const void* at, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += line) __builtin_prefetch(static_cast<const char*>(at) + i);
  };
  if (child.is_instance()) return;
  if (child.is_leaf())
    lines(leaves + child.index(), sizeof(Leaf));
  else
    lines(nodes + child.index(), sizeof(WideNode));
}

/// What a traversal tests: nothing is counted, or the boxes of a node's children and the triangles of a leaf.
struct NoCounts {
  static WorkCounts* work() { return nullptr; }
  void node(const WideNode&) const {}
  void leaf(const LeafTriangles&) const {}
};
struct CountTests {
  WorkCounts& counts;
  WorkCounts* work() const { return &counts; }
  void node(const WideNode& node) const {
    for (std::size_t i = 0; i < node_lanes; ++i)
      counts.boxes += node.bounds[0][i] <= node.bounds[3][i] ? 1 : 0;
  }
  void leaf(const LeafTriangles& triangles) const { counts.primitives += triangles.last() + 1; }
};

/// Stands for the instances of trees in which there are none.
struct NoInstances {
  bool operator()(std::uint32_t) const { return false; }
};

/// intersect(leaf) and enter(an instance's number) return true to end the traversal.
template <Order order, class Leaf, class Counts, class Intersect, class Enter = NoInstances>
HWY_INLINE WideTraversal traverse(const WideTree& tree, WideRay& ray, const Counts& counts,
                                  const Intersect& intersect, const Enter& enter = {}) {
  constexpr bool has_instances = !std::is_same_v<Enter, NoInstances>;
  const SpreadRay spread(ray);
  const WideNode* nodes = tree.nodes.data();
  const Leaf* leaves = leaves_of<Leaf>(tree);
  float t_max = ray.t_max;
  Stack stack;
  std::size_t size = 0;
  std::size_t known = 0;  // on the stack, asked for already
  const auto comes_too_late = [&](std::size_t i) { return order != Order::any && stack.near[i] > t_max; };
  const auto ask_ahead = [&] {
    if (size > known) prefetch(nodes, leaves, WideChild{stack.child[size - 1]});
    known = size;
  };
  WideChild child{0};
  for (;;) {
    if (has_instances && child.is_instance()) {
      if (enter(child.index())) return WideTraversal::ended;
      t_max = ray.t_max;
    } else if (child.is_leaf()) {
      counts.leaf(leaves[child.index()].triangles);
      if (intersect(leaves[child.index()])) return WideTraversal::ended;
      t_max = ray.t_max;
    } else if (size > 0 && !WideChild{stack.child[size - 1]}.is_leaf() && !comes_too_late(size - 1)) {
      known = 0;
      const WideNode& after = nodes[stack.child[--size]];
      counts.node(nodes[child.index()]), counts.node(after);
      if (visit_children_of_two<order>(nodes[child.index()], after, spread, t_max, stack, size, child.bits)) {
        ask_ahead();
        continue;
      }
    } else {
      const WideNode& node = nodes[child.index()];
      counts.node(node);
      if (IntersectedChildren<order>(node, spread, t_max).take(node, spread, stack, size, child.bits)) {
        ask_ahead();
        continue;
      }
    }
    do {
      if (size == 0) return WideTraversal::done;
      child.bits = stack.child[--size];
    } while (comes_too_late(size));
    known = 0;
    ask_ahead();
  }
}

/// Where a tree's leaves are in the world's leaf order, and its triangles among the world's.
struct Place {
  std::uint32_t first_leaf = 0, first_triangle = 0;
  const WideInstance* instance = nullptr;  ///< null: those of no instance
  Place() = default;
  explicit Place(const WideInstance& of)
      : first_leaf(of.first_leaf), first_triangle(of.first_triangle), instance(&of) {}
};

/// A ray's numbers in the space of an instance's mesh.
class PlacedNumbers {
 public:
  HWY_INLINE PlacedNumbers(const WideInstance& instance, const RayNumbers& ray) : t_(ray.t) {
    for (std::size_t i = 0; i < 4; i += hn::MaxLanes(d)) {
      const auto column = [&](int c) { return hn::LoadU(d, &instance.object_from_world[c][0] + i); };
      const auto times = [&](double x, double y, double z) {
        return hn::MulAdd(column(0), hn::Set(d, x),
                          hn::MulAdd(column(1), hn::Set(d, y), hn::Mul(column(2), hn::Set(d, z))));
      };
      const auto from = [&](int a) { return ray.origin[a] - instance.translation[a]; };
      hn::Store(times(from(0), from(1), from(2)), d, origin_ + i);
      hn::Store(times(ray.direction[0], ray.direction[1], ray.direction[2]), d, direction_ + i);
    }
  }
  RayNumbers numbers() const { return {origin_, direction_, t_, start_}; }

  /// Moves the origin near the mesh where that lies far ahead. False: it does not.
  [[gnu::noinline]] bool move_near(const WideTree& mesh) {
    double offset[3];
    std::size_t z = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      offset[a] = origin_[a] - mesh.center[a];
      if (std::abs(direction_[a]) > std::abs(direction_[z])) z = a;
    }
    const double before = 16.0 * static_cast<double>(mesh.reach);
    const double start = -(offset[z] + std::copysign(before, direction_[z])) / direction_[z];
    if (!(start > 0.0 && start < infinity)) return false;
    for (std::size_t a = 0; a < 3; ++a) origin_[a] += start * direction_[a];
    start_ = start, t_ = {std::max(t_.min - start, 0.0), t_.max - start};
    return true;
  }

 private:
  static constexpr hn::CappedTag<double, 4> d{};
  static_assert(offsetof(WideInstance, translation) ==
                offsetof(WideInstance, object_from_world) +
                    sizeof(Mat3));  // what the last column's load reads, too
  Interval t_;
  double start_ = 0.0;
  alignas(32) double origin_[4], direction_[4];
};

/// A ray in the space of an instance's mesh; `error`: as error_in_world() says, `frame_t`: what prepare returned. False: floats
/// do not suffice there.
HWY_INLINE bool place_ray(const WideInstance& instance, const Ray& given, const TraversalLimits& limits,
                          double error, double frame_t, const WideRay& ray, WideRay& placed) {
  if (!has_bounds(instance, error)) return false;
  PlacedNumbers numbers(instance, numbers_of(given));
  const TraversalLimits here{.t_above = ray.t_max, .beyond = limits.beyond, .frame_t = frame_t};
  return prepare(*instance.mesh, numbers.numbers(), here, placed) > 0.0 ||
         (numbers.move_near(*instance.mesh) &&
          prepare(*instance.mesh, numbers.numbers(), here, placed) > 0.0);
}

/// Goes through a tree with instances; `ray`: what prepare made of `given`, `frame_t`: what it returned. Calls leaf(tree,
/// leaf, ray, place) for every leaf of a mesh or of what is flattened. Calls plainly(position in leaf order, ray) for
/// every leaf primitive of an instance for which floats do not suffice. Both return true to end.
template <class Verb, class Counts>
HWY_NOINLINE WideTraversal traverse_instances(const WideTree& tree, const Ray& given,
                                              const TraversalLimits& limits, double frame_t, WideRay& ray,
                                              const Verb& verb, const Counts& counts) {
  const double error = error_in_world(given.origin, limits.origin_error);
  const auto enter = [&](std::uint32_t number) {
    const WideInstance& instance = tree.instances[number];
    WideRay placed;
    if (!place_ray(instance, given, limits, error, frame_t, ray, placed)) {
      const auto visit = [&](std::uint32_t leaf) { return verb.plainly(leaf, ray); };
      return visit_plainly(tree, number, given, limits, ray, visit, counts.work());
    }
    const Place place(instance);
    const auto traversed = traverse<Verb::order, WideLeaf>(
        *instance.mesh, placed, counts,
        [&](const WideLeaf& leaf) { return verb.leaf(*instance.mesh, leaf, placed, place); });
    ray.t_max = std::min(ray.t_max, placed.given_above(placed.t_max));
    return traversed == WideTraversal::ended;
  };
  const auto intersect = [&](const WideLeaf& leaf) { return verb.leaf(tree, leaf, ray, Place{}); };
  return traverse<Verb::order, WideLeaf>(tree, ray, counts, intersect, enter);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
