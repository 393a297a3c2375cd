// What the space-dividing structures share when they are built: the primitives' boxes, and whether a
// primitive may reach into a box-shaped cell. A budget keeps the number of references bounded. A cell is
// closed and so is a primitive; every test errs on the side of "may", so no structure loses a primitive in a
// cell's wall. Separating axes: Akenine-Moeller 2001, "Fast 3D triangle-box overlap testing".
#pragma once

#include "raytrace/bvh/bvh.h"

namespace gnomon::raytrace {

/// Relative to Bvh::center, like all the hierarchy's boxes.
struct CellBox {
  std::array<float, 3> min, max;
  double extent(std::size_t axis) const {
    return static_cast<double>(max[axis]) - static_cast<double>(min[axis]);
  }
  double half_area() const { return extent(0) * extent(1) + extent(1) * extent(2) + extent(2) * extent(0); }
};

/// The finite primitives by their place in ascending order of ids: the order of build_flat().
class CellItems {
 public:
  explicit CellItems(const World& world);

  std::uint32_t count() const { return static_cast<std::uint32_t>(finite_.boxes.size()); }
  const BoxRef& box(std::uint32_t item) const { return finite_.boxes[item]; }
  const Vec3& center() const { return finite_.center; }
  const World& world() const { return *world_; }
  /// Returns the box around all boxes; meaningless when there are none.
  const CellBox& bounds() const { return bounds_; }

  /// False only if the primitive surely has no point in the closed cell.
  bool may_overlap(std::uint32_t item, const CellBox& cell) const;
  /// A triangle's corners relative to the centre.
  std::array<Vec3, 3> corners(std::uint32_t item) const;
  bool is_triangle(std::uint32_t item) const { return world_->is_triangle(finite_.boxes[item].id); }

 private:
  const World* world_;
  FinitePrimitives finite_;
  CellBox bounds_;
};

/// References that a subtree may still add to those it was given. Splitting spends what it duplicates and
/// shares the rest among the children by their size, so the bound holds whatever the threads do.
struct ReferenceBudget {
  std::uint64_t spare;

  static ReferenceBudget for_items(std::uint64_t count) { return {7 * count + 4096}; }
  bool affords(std::uint64_t parent, std::uint64_t children) const { return children <= parent + spare; }
  ReferenceBudget share(std::uint64_t parent, std::uint64_t children, std::uint64_t child) const {
    const std::uint64_t left = parent + spare - children;
    return {children == 0
                ? 0
                : static_cast<std::uint64_t>(static_cast<double>(left) / static_cast<double>(children) *
                                             static_cast<double>(child))};
  }
};

}  // namespace gnomon::raytrace
