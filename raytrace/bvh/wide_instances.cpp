#include "raytrace/bvh/wide_instances.h"

#include "raytrace/bvh/traverse.h"

namespace gnomon::raytrace {
namespace {

/// Returns the largest sum of a row's sizes of a matrix: by how much it makes vectors longer at most, in the maximum norm.
double norm_of(const Mat3& m) {
  return max_component(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

constexpr double world_rounding = 0x1p-46, inverse_rounding = 0x1p-40;
constexpr double most_norm = 0x1p40;  // so that floats have the quotient of two units of t

template <class Stats>
bool visit_placed(const Bvh& bvh, const BvhInstance& placed, BoxRay& boxes, WideRay& limited, Stats stats,
                  const FunctionRef<bool(std::uint32_t leaf)>& visit) {
  const NodesPlaced there{placed};
  return traverse_tree(bvh.trees[placed.tree], there, boxes, stats, [&](BvhChild leaf) {
    const LeafRange range = there.leaves({leaf.first(), leaf.count()});
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      stats.primitive();
      if (visit(i)) return true;
    }
    boxes.t_max = std::min(boxes.t_max, limited.t_max);
    return false;
  });
}

}  // namespace

void add_wide_instances(const World& world, WideTree& tree) {
  const Bvh& bvh = *tree.origin;
  for (const Bvh& mesh : bvh.trees) tree.trees.push_back(collapse_bvh(mesh, world));
  for (const BvhInstance& placed : bvh.instances) {
    const Mat3 matrix(placed.world_from_object);
    const WideTree* mesh = tree.trees[placed.tree].get();
    WideInstance instance{};
    instance.object_from_world = glm::inverse(matrix),
    instance.translation = Vec3(placed.world_from_object[3]);
    instance.first_leaf = placed.first_leaf, instance.first_triangle = placed.first_triangle;
    const double norm = norm_of(matrix);
    instance.inverse_norm = norm_of(instance.object_from_world);
    if (mesh != nullptr && std::max(norm, instance.inverse_norm) <= most_norm) {
      const auto reach = static_cast<double>(mesh->reach);
      const double around = max_component(glm::abs(mesh->origin->center)) + reach;
      const double size = max_component(glm::abs(instance.translation)) + norm * around;
      instance.error = instance.inverse_norm * (world_rounding * size + inverse_rounding * norm * reach);
      instance.mesh = mesh;
    }
    tree.instances.push_back(instance);
  }
}

double error_in_world(const Vec3& origin, double origin_error) {
  return origin_error + world_rounding * max_component(glm::abs(origin));
}

bool visit_plainly(const WideTree& tree, std::uint32_t instance, const Ray& ray,
                   const TraversalLimits& limits, WideRay& limited,
                   FunctionRef<bool(std::uint32_t leaf)> visit, WorkCounts* work) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return false;
  const Bvh& bvh = *tree.origin;
  BoxRay boxes(*frame, bvh.center, Vec3(limits.origin_error));
  boxes.t_max = limited.t_max;
  const BvhInstance& placed = bvh.instances[instance];
  return work != nullptr ? visit_placed(bvh, placed, boxes, limited, CountWork{*work}, visit)
                         : visit_placed(bvh, placed, boxes, limited, NoStats{}, visit);
}

}  // namespace gnomon::raytrace
