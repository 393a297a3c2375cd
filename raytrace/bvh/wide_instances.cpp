#include "raytrace/bvh/wide_instances.h"

#include "raytrace/bvh/traverse.h"

namespace gnomon::raytrace {
namespace {

/// Of a matrix the largest sum of a row's sizes: by how much it makes vectors longer at most, in the maximum norm.
double norm_of(const Mat3& m) {
  return max_component(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

constexpr double world_rounding = 0x1p-46, inverse_rounding = 0x1p-40, most_error = 0x1p-35;
constexpr double most_norm = 0x1p40;  // so that floats have the quotient of two units of t
constexpr double unknown = std::numeric_limits<double>::infinity();

/// A ray on its way through instances.
class Traversal {
 public:
  Traversal(const WideTree& tree, const Ray& ray, const RayFrame& frame, const TraversalLimits& limits,
            WorkCounts* work)
      : tree_(tree),
        ray_(ray),
        limits_(limits),
        work_(work),
        boxes_(frame, tree.origin->center, Vec3(limits.origin_error)) {
    const double last = ray.t.max + limits.beyond;
    boxes_.t_max = std::min(float_above(last * frame.kernel_t_from_t), limits.t_above);
    limits_.frame_t = frame.kernel_t_from_t;
  }

  /// No hit from here on counts any more; in the units of RayFrame.
  void limit(float t) { boxes_.t_max = std::min(boxes_.t_max, t); }

  /// Nearest first, roughly: there(instance, its ray, its limits), or plainly(leaf) for every leaf of an instance for
  /// which floats do not suffice, which returns true to end all.
  template <class There, class Plainly>
  WideTraversal run(const There& there, const Plainly& plainly) {
    return work_ != nullptr ? run(CountWork{*work_}, there, plainly) : run(NoStats{}, there, plainly);
  }

 private:
  template <class Stats, class There, class Plainly>
  WideTraversal run(Stats stats, const There& there, const Plainly& plainly) {
    const Bvh& bvh = *tree_.origin;
    auto result = WideTraversal::done;
    const auto enter = [&](BvhChild child) {
      if (!child.is_instance()) return false;
      const WideInstance& instance = tree_.instances[child.instance()];
      const BvhInstance& placed = bvh.instances[child.instance()];
      const WideTree* wide = tree_.trees[placed.tree].get();
      if (wide != nullptr && has_bounds(instance, *wide)) {
        Ray ray = ray_;
        ray.origin = instance.object_from_world * (ray_.origin - instance.translation);
        ray.direction = instance.object_from_world * ray_.direction;
        TraversalLimits limits = limits_;
        limits.t_above = boxes_.t_max, limits.origin_error = 0.0;
        result = there(*wide, placed, ray, limits);
      } else {
        result = WideTraversal::refused;
      }
      if (result == WideTraversal::refused) result = go_plainly(bvh, placed, stats, plainly);
      return result != WideTraversal::done;
    };
    traverse_tree(bvh, NodesThere{}, boxes_, stats, enter, bvh.upper_root);
    return result;
  }

  bool has_bounds(const WideInstance& instance, const WideTree& wide) const {
    const double error = limits_.origin_error + world_rounding * max_component(glm::abs(ray_.origin));
    return instance.inverse_norm * error + instance.error <= most_error * static_cast<double>(wide.reach);
  }

  template <class Stats, class Plainly>
  WideTraversal go_plainly(const Bvh& bvh, const BvhInstance& placed, Stats& stats, const Plainly& plainly) {
    const NodesPlaced there{placed};
    const bool ended = traverse_tree(bvh.trees[placed.tree], there, boxes_, stats, [&](BvhChild leaf) {
      const LeafRange range = there.leaves({leaf.first(), leaf.count()});
      for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
        stats.primitive();
        if (plainly(i)) return true;
      }
      return false;
    });
    return ended ? WideTraversal::ended : WideTraversal::done;
  }

  const WideTree& tree_;
  const Ray& ray_;
  TraversalLimits limits_;
  WorkCounts* work_;
  BoxRay boxes_;
};

using Verb = WideTraversal (*)(const WideTree&, const Ray&, const TraversalLimits&, CandidateVisitor,
                               WorkCounts*);

/// By the verb for trees without instances; what is flattened comes first.
WideTraversal visit_by(Verb verb, const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                       CandidateVisitor visit, WorkCounts* work) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return WideTraversal::refused;
  Traversal traversal(tree, ray, *frame, limits, work);
  if (!tree.nodes.empty()) {
    const auto flattened = [&](std::uint32_t leaf, WideRay& limited) {
      const bool ends = visit(leaf, limited);
      traversal.limit(limited.t_max);
      return ends;
    };
    const WideTraversal traversed = verb(tree, ray, limits, flattened, work);
    if (traversed != WideTraversal::done) return traversed;
  }
  const auto there = [&](const WideTree& wide, const BvhInstance& placed, const Ray& placed_ray,
                         const TraversalLimits& placed_limits) {
    const auto visit_placed = [&](std::uint32_t leaf, WideRay& limited) {
      const bool ends = visit(placed.first_leaf + leaf, limited);
      traversal.limit(limited.t_max / limited.unit);
      return ends;
    };
    return verb(wide, placed_ray, placed_limits, visit_placed, work);
  };
  WideRay limited;
  limited.t_max = FLT_MAX, limited.unit = 1.0f;
  const auto plainly = [&](std::uint32_t leaf) {
    const bool ends = visit(leaf, limited);
    traversal.limit(limited.t_max);
    return ends;
  };
  return traversal.run(there, plainly);
}

bool keep(LeafCandidates& found, std::uint32_t leaf) {
  if (found.count == LeafCandidates::most) return false;
  found.leaf[found.count] = leaf, found.t[found.count++] = -std::numeric_limits<float>::infinity();
  return true;
}

}  // namespace

void put_wide_instances(const World& world, WideTree& tree) {
  const Bvh& bvh = *tree.origin;
  for (const Bvh& mesh : bvh.trees) tree.trees.push_back(collapse_bvh(mesh, world));
  for (const BvhInstance& placed : bvh.instances) {
    const Mat3 matrix(placed.world_from_object);
    WideInstance instance{glm::inverse(matrix), Vec3(placed.world_from_object[3]), 0.0, unknown};
    instance.inverse_norm = norm_of(instance.object_from_world);
    const double norm = norm_of(matrix);
    const WideTree* wide = tree.trees[placed.tree].get();
    if (wide != nullptr && std::max(norm, instance.inverse_norm) <= most_norm) {
      const auto reach = static_cast<double>(wide->reach);
      const double around = max_component(glm::abs(wide->origin->center)) + reach;
      const double size = max_component(glm::abs(instance.translation)) + norm * around;
      instance.error = instance.inverse_norm * (world_rounding * size + inverse_rounding * norm * reach);
    }
    tree.instances.push_back(instance);
  }
}

WideTraversal visit_in_instances(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                 CandidateVisitor visit, WorkCounts* work) {
  return visit_by(visit_in_tree, tree, ray, limits, visit, work);
}

WideTraversal visit_ambiguous_in_instances(const WideTree& tree, const Ray& ray, CandidateVisitor visit,
                                           WorkCounts* work) {
  return visit_by(visit_ambiguous_in_tree, tree, ray, {}, visit, work);
}

WideTraversal ambiguous_in_instances(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                     std::uint32_t skip, LeafCandidates& found) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return WideTraversal::refused;
  if (!tree.nodes.empty()) {
    const WideTraversal traversed = ambiguous_in_tree(tree, ray, limits, skip, found);
    if (traversed != WideTraversal::done) return traversed;
  }
  bool full = false;
  const auto there = [&](const WideTree& wide, const BvhInstance& placed, const Ray& placed_ray,
                         const TraversalLimits& placed_limits) {
    LeafCandidates here;
    // Another triangle's number wraps to one that the mesh does not have.
    const WideTraversal traversed =
        ambiguous_in_tree(wide, placed_ray, placed_limits, skip - placed.first_triangle, here);
    for (std::size_t i = 0; traversed == WideTraversal::done && i < here.count; ++i)
      full = full || !keep(found, placed.first_leaf + here.leaf[i]);
    return full ? WideTraversal::ended : traversed;
  };
  const auto plainly = [&](std::uint32_t leaf) {
    full = full || (tree.origin->id_at(leaf) != skip && !keep(found, leaf));
    return full;
  };
  const WideTraversal traversed = Traversal(tree, ray, *frame, limits, nullptr).run(there, plainly);
  return full ? WideTraversal::refused : traversed;
}

}  // namespace gnomon::raytrace
