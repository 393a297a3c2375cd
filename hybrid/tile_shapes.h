// Planes and spheres as one tile of the map sees them. In texel coordinates and reciprocal depth a plane is linear
// and a ball before the light stays convex (both maps are projective). So the near side of a sphere is a concave
// function of (u, v) and its far side a convex one. Over a texel they are bounded by the values at its corners and
// at its centre.
#pragma once

#include <array>
#include <optional>

#include "hybrid/tile_triangle.h"
#include "scene/shapes/solid.h"

namespace gnomon::hybrid {

/// The tile's corner and the texel's sides: tangents (perspective) or world units from the view's origin.
struct TileSquare {
  double x, y, step_x, step_y;
};
TileSquare place_of(const LightView& view, int face, int tile_x, int tile_y);

/// A surface over every texel of a tile, without an edge (but, for a plane, its horizon).
struct Cover {
  TileFunction reciprocal_depth;
  float error;      ///< of the reciprocal depth; infinite: only low and high are known
  float low, high;  ///< of the reciprocal depth over the whole tile
  Facing facing;
  bool boundary;
  std::uint32_t triangle = no_id;  ///< none: a plane
  /// Over the square of 2 x half_texels around (x, y); low > high: not there (beyond the horizon).
  Piece at(float x, float y, float half_texels) const;
};

/// Nothing where the tile lies beyond the horizon.
std::optional<Cover> plane_cover(const SheetGrid& grid, int face, int tile_x, int tile_y, const Plane& plane,
                                 bool masked);

/// A ball that holds a shape that is neither sphere nor plane.
Sphere ball_around(const ShapeGeometry& geometry);

class SphereColumns {
 public:
  SphereColumns(const SheetGrid& grid, int face, int tile_x, int tile_y, const Sphere& sphere, bool masked);
  bool misses_tile() const { return misses_; }
  /// The light may be inside or too close: nothing is known of where its sides are.
  bool is_everywhere() const { return everywhere_; }
  /// The near and the far side in a column; nothing where it surely misses.
  std::optional<std::array<Piece, 2>> at(int x, int y) const;

 private:
  struct Crossing {  // reciprocal depth where a light ray enters and leaves
    double enters, leaves;
  };
  std::optional<Crossing> cross(double x, double y) const;
  bool surely_misses(double x, double y) const;  ///< of the texel around a centre

  bool perspective_, masked_, misses_ = false, everywhere_ = false;
  double x0_, y0_, step_x_,
      step_y_;   // the tile's first texel and a texel, on the plane of depth 1 (or in world units)
  Vec3 center_;  // light space
  double radius_;
  double least_, most_;  // reciprocal depth
};

}  // namespace gnomon::hybrid
