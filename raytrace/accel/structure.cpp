#include "raytrace/accel/structure.h"

#include "raytrace/accel/any_structure.h"

namespace gnomon::raytrace {
namespace {

template <class Stats>
bool traverse_any(const Structure& structure, BoxRay& ray, Stats stats, const LeafVisitor& visit) {
  return std::visit(
      [&]<class Held>(const Held& held) {
        if constexpr (std::is_same_v<Held, std::monostate>)
          return false;
        else
          return traverse(held, ray, stats, visit);
      },
      structure);
}

}  // namespace

bool has_structure(Accel accel) {
  return accel != Accel::bvh && accel != Accel::brute;
}

Structure build_structure(const World& world, Accel accel) {
  if (!has_structure(accel)) return {};
  if (accel == Accel::two_level) return build_two_level(world);
  const CellItems items(world);
  switch (accel) {
    case Accel::bvh_median:
      return build_median_bvh(items);
    case Accel::kdtree:
      return build_kdtree(items);
    case Accel::kdtree_cyclic:
      return build_kdtree(items, KdSplit::cyclic_median);
    case Accel::octree:
      return build_octree(items);
    case Accel::grid:
      return build_grid(items);
    case Accel::grid_textbook:
      return build_grid(items, {.density = GridOptions::textbook_density});
    case Accel::bsp:
      return build_bsp(items);
    case Accel::bvh:
    case Accel::two_level:
    case Accel::brute:
      break;
  }
  return {};
}

StructureSize size_of(const Structure& structure) {
  if (const auto* s = std::get_if<MedianBvh>(&structure)) return {s->nodes.size(), s->bytes()};
  if (const auto* s = std::get_if<KdTree>(&structure)) return {s->nodes.size(), s->bytes()};
  if (const auto* s = std::get_if<Octree>(&structure)) return {s->nodes.size(), s->bytes()};
  if (const auto* s = std::get_if<UniformGrid>(&structure)) return {s->nodes(), s->bytes()};
  if (const auto* s = std::get_if<BspTree>(&structure))
    return {s->nodes.size() + s->leaves.size(), s->bytes()};
  if (const auto* s = std::get_if<TwoLevel>(&structure)) return {s->nodes(), s->bytes()};
  return {};
}

bool traverse_structure(const Structure& structure, BoxRay& ray, WorkCounts* work, const LeafVisitor& visit) {
  return work != nullptr ? traverse_any(structure, ray, CountWork{*work}, visit)
                         : traverse_any(structure, ray, NoStats{}, visit);
}

}  // namespace gnomon::raytrace
