#include "raytrace/accel/structure.h"

namespace gnomon::raytrace {

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
  if (const auto* s = std::get_if<MedianBvh>(&structure))
    return {s->nodes.size(), s->items.size(), s->bytes()};
  if (const auto* s = std::get_if<KdTree>(&structure)) return {s->nodes.size(), s->items.size(), s->bytes()};
  if (const auto* s = std::get_if<Octree>(&structure)) return {s->nodes.size(), s->items.size(), s->bytes()};
  if (const auto* s = std::get_if<UniformGrid>(&structure)) return {s->nodes(), s->items.size(), s->bytes()};
  if (const auto* s = std::get_if<BspTree>(&structure))
    return {s->nodes.size() + s->leaves.size(), s->items.size(), s->bytes()};
  if (const auto* s = std::get_if<TwoLevel>(&structure))
    return {s->nodes(), s->placements.size(), s->bytes()};
  return {};
}

}  // namespace gnomon::raytrace
