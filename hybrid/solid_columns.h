// Solids (scene/shapes/solid.h) as one tile of the map sees them: what interval arithmetic proves of each texel's
// column (Moore 1966; Mitchell 1990). The column is cut into slabs of depth, and the solid's function is
// bounded over each. Where it is surely above 0 there is no surface; where it is surely below 0 every ray is
// inside a closed body, and has come in through its surface before. Of an open surface, two slabs of surely
// different sign within its box have the surface between them.
//
// The function may only fall (or only rise) along every ray from a slab without surface to one behind the
// surface. Each ray then meets it there once. That part is a single sheet, which cannot shadow itself. So is
// the near side of a convex body, and its far side.
#pragma once

#include <array>

#include "hybrid/tile_shapes.h"
#include "raytrace/precision/bounds.h"

namespace gnomon::hybrid {

class SolidColumns {
 public:
  struct Pieces {
    std::array<Piece, 2> piece{};
    int count = 0;  ///< 0: the column surely misses the solid
    void add(const Piece& p) { piece[static_cast<std::size_t>(count++)] = p; }
  };

  SolidColumns(const SheetGrid& grid, int face, int tile_x, int tile_y, const ShapeGeometry& solid,
               bool masked);
  bool misses_tile() const { return misses_; }
  /// The light may be inside the solid's ball, or too close to it: nothing is known.
  bool is_everywhere() const { return everywhere_; }
  /// The square of `texels` texels a side from (x, y) on surely misses the solid.
  bool misses(int x, int y, int texels) const;
  Pieces at(int x, int y) const;

 private:
  using Bounds = raytrace::Bounds;
  /// A column's rays in the solid's frame: start + depth * direction.
  struct Column {
    std::array<Bounds, 3> start, direction;
  };
  /// Says what a slab is; negative and positive: of an open surface, within its box.
  enum class Slab : std::uint8_t { outside, inside, negative, positive, unknown };
  struct Scan;

  Column column(int x, int y, int texels) const;
  std::array<Bounds, 3> places(const Column& column, double from, double to) const;
  Slab slab(const Column& column, double from, double to, bool& continuous) const;
  /// Slab `index` of the 2^level ones that the depths between ends_ are cut into; backwards: from the far
  /// end on. False: enough is known.
  bool scan(const Column& column, int level, int index, Scan& scan) const;
  /// Each ray meets the surface at most once between these depths.
  bool met_once(const Column& column, double from, double to) const;
  double depth_at(int level, int index, bool backwards) const;
  float nearest(double depth) const;   ///< an upper bound on its reciprocal depth
  float farthest(double depth) const;  ///< a lower bound

  const ShapeGeometry& solid_;
  bool perspective_, masked_, closed_, convex_, misses_ = false, everywhere_ = false;
  Aabb box_;
  int first_cut_;
  double x0_, y0_, step_x_, step_y_;   // as SphereColumns
  double error_;                       // of positions, world units
  Vec3 start_, right_, up_, forward_;  // in the solid's frame
  std::array<double, 2> ends_{};       // of depth
};

}  // namespace gnomon::hybrid
