// Which triangles hang together inside one texel's column of light rays. Two do where the edge that they share (vertices
// welded by position) crosses the column and both face the same way. A *sheet* is all that hangs together so. Every
// decision is conservative: rounding can only let an edge cross the column.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "raytrace/sheets/column.h"
#include "raytrace/sheets/sheets.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {

/// The sheets of a column, each found when it is first asked for, from one of its triangles on.
class ColumnSheets {
 public:
  /// World and topology must outlive this.
  ColumnSheets(const World& world, const Topology& topology, const LightView& view, TexelKey texel)
      : world_(world), topology_(topology), column_(view, texel.face(), texel.column(), texel.row()) {}

  /// Whether triangle b is on a's sheet, which is found from a on until b is met.
  bool same(std::uint32_t a, std::uint32_t b);

 private:
  struct Piece {
    std::uint32_t triangle;
    std::array<LightVertex, 3> corners;
    int facing;
  };
  Piece piece(std::uint32_t triangle) const;
  void begin(std::uint32_t triangle);
  void grow_until_met(std::uint32_t triangle);
  void add_neighbours(const Piece& from);

  const World& world_;
  const Topology& topology_;
  const TexelColumn column_;
  std::unordered_map<std::uint32_t, std::uint32_t>
      first_;                 ///< by triangle, the one that its sheet is found from
  std::vector<Piece> queue_;  ///< of the last sheet: what was found of it, from the first one on
  std::size_t next_ = 0;      ///< of the queue, whose neighbours come next
};

// The sheets of a solid (scene/shapes/solid.h), which may be several on one side when it is not convex.

/// Whether two points of a solid's surface surely lie on one sheet of it. Between the light rays through them
/// the surface is then hit once by each ray, near the chord from one to the other. A convex solid's points on
/// the side that faces the light always do. Of the others the proof is by interval arithmetic, and false may
/// mean that none was found. The directions are those of the light rays through a and b.
bool hang_together(const ShapeGeometry& solid, const Vec3& a, const Vec3& b, const Vec3& direction_a,
                   const Vec3& direction_b);

}  // namespace gnomon::raytrace
