// What one texel's column says of a receiver by its reciprocal depth, and how that follows from the pieces of surface
// that the column meets.
//
// Pieces of one facing whose reciprocal depth intervals overlap form a group. Triangles that share an edge crossing
// the column overlap there, so every sheet (raytrace/sheets/sheets.h) lies in one group. In a group that no boundary
// edge crosses, the projection along the rays is a covering. Its degree is the number of pieces over any one point
// of the texel that lies on no edge. Degree 1: the group is one sheet without boundary and cannot shadow itself.
// Degree >= 1: every ray of the column meets it. Degree 0: it lies beside the column, and only rounding put it
// there. A group whose pieces' projections do not overlap cannot shadow itself either, whatever edges it has. That
// may be a single triangle, two that share an edge, or a few that lie apart.
//
// Where groups are ambiguous, the sheets themselves are put together, by the edges that cross the column.
//
// Nothing changes when a linear function of the place in the texel is taken off all reciprocal depths alike. With
// the slope of the nearest surface taken off, thin bodies seen at a grazing angle come apart. A wall's two sides
// are then two groups, however deep the texel reaches along it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace gnomon::hybrid {

/// The slope (per texel from the texel's centre) is taken off the reciprocal depth of a receiver in the column.
/// Above `lit_above` it is surely lit, below `dark_below` surely shadowed, else ambiguous. Both at once is
/// impossible for a point on a surface.
struct TexelBounds {
  float lit_above, dark_below;
  float slope_u, slope_v;
};
inline constexpr float inf = std::numeric_limits<float>::infinity();
inline constexpr float no_reciprocal_depth = inf;
inline constexpr TexelBounds ambiguous_texel{no_reciprocal_depth, -no_reciprocal_depth, 0.0f, 0.0f};
inline constexpr TexelBounds empty_texel{-no_reciprocal_depth, -no_reciprocal_depth, 0.0f, 0.0f};

enum class Facing : std::uint8_t { towards, away, edge_on };

/// A piece of surface in a column.
struct Piece {
  static constexpr std::uint32_t no_slot = 0xffffffffu;
  float low, high;  ///< bounds on its reciprocal depth there
  /// Its plane: reciprocal depth at the column's centre and slope per texel, and the error of that; infinite: no
  /// plane is known.
  float middle = 0.0f, slope_u = 0.0f, slope_v = 0.0f, error = no_reciprocal_depth;
  Facing facing = Facing::edge_on;
  bool boundary = false;      ///< an edge that ends a sheet may cross the column, or is of unknown place
  bool covers = false;        ///< lies over the texel's sample point
  std::uint8_t crossing = 0;  ///< bit k: its edge k, an inner one of a sheet, may cross the column
  std::uint32_t triangle = 0xffffffffu;  ///< in the world; none: a shape's
  std::uint32_t slot = no_slot;          ///< what PieceRelations::clip knows it by
  std::uint32_t parent = 0;              ///< while sheets are put together
};

/// What only the triangles themselves can tell.
class PieceRelations {
 public:
  virtual ~PieceRelations() = default;
  /// The projections of two equally facing triangles surely have no inner point in common.
  virtual bool apart(std::uint32_t a, std::uint32_t b) const = 0;
  /// Narrows low and high of a triangle's piece, its plane less the slope, to what lies in the column.
  virtual void clip(Piece& piece, float slope_u, float slope_v) const = 0;
  /// The triangle across an inner edge.
  virtual std::uint32_t across(std::uint32_t triangle, int edge) const = 0;
};

struct ColumnBounds {
  TexelBounds bounds = empty_texel;
  bool decisive = true;  ///< every receiver on the nearest surface is surely lit
};

/// Both reorder the pieces; the column reaches `half_texels` from its centre. By groups, fast:
ColumnBounds quick_bounds_of(std::span<Piece> pieces, float half_texels, const PieceRelations& relations);
/// By sheets, narrowed to what lies in the column.
ColumnBounds bounds_of(std::span<Piece> pieces, float half_texels, const PieceRelations& relations);

}  // namespace gnomon::hybrid
