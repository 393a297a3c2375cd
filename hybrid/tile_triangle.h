// A triangle as one 32 x 32 tile of the map sees it: three edge functions and a reciprocal depth, linear over the
// tile. They are floats with all rounding given away. As in Olano and Greer 1997, "Triangle scan conversion using
// 2D homogeneous coordinates", there is no division, so a triangle may reach behind the light. Edge functions are
// scaled to |a| + |b| = 1: over a texel they change by at most one half from its centre.
#pragma once

#include <array>

#include "hybrid/sheet_grid.h"
#include "hybrid/texel_bounds.h"

namespace gnomon::hybrid {

/// u * x + v * y + c for x, y in texels from the tile's corner.
struct TileFunction {
  float u = 0.0f, v = 0.0f, c = 0.0f;
  float at(float x, float y) const { return u * x + (v * y + c); }
};

struct TileTriangle {
  std::array<TileFunction, 3> edge;         ///< >= 0 inside; of edge k (corners k, k + 1)
  std::array<float, 3> error;               ///< of its value
  std::array<float, 3> depth;               ///< of the triangle below each edge, texels; for edge-on ones
  std::array<std::array<float, 4>, 3> box;  ///< of the edges: x min, max, y min, max, widened
  TileFunction reciprocal_depth;
  float reciprocal_depth_error = 0.0f;  ///< infinite: no plane is known
  float low = 0.0f, high = 0.0f;        ///< of the reciprocal depth over the whole triangle
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;   ///< texels that it may meet: x0 ... x1
  std::uint8_t boundary = 0;            ///< as TriangleFacing
  Facing facing = Facing::towards;
  std::uint32_t id = 0;
  std::uint32_t slot = Piece::no_slot;
  bool clipped = false;          ///< it may reach behind the light: no corners
  std::array<Vec2, 3> corner{};  ///< texels from the tile's corner
};

class TileFrame {
 public:
  TileFrame(const SheetGrid& grid, int face, int tile_x, int tile_y);

  /// Returns false where the triangle surely misses the tile. `corners`: on this face.
  bool set_up(const std::array<ProjectedPoint, 3>& corners, TriangleFacing facing, TileTriangle& out) const;
  /// The triangle surely covers every texel of the tile, and no edge crosses it; or it may meet every texel, and each knows as
  /// little of it as the others, as of one that the light touches.
  static bool covers_tile(const TileTriangle& triangle);

 private:
  struct Corners;
  bool find_box(const Corners& corners, TileTriangle& out) const;
  void find_edges(Corners& corners, double inside, TileTriangle& out) const;
  void find_reciprocal_depth(const std::array<ProjectedPoint, 3>& points, const Corners& corners,
                             TileTriangle& out) const;

  const SheetGrid& grid_;
  double u0_, v0_;      // the tile's first texel
  int width_, height_;  // texels of it on the map
  double handedness_;
};

}  // namespace gnomon::hybrid
