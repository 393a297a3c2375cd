// The texels of one tile: every piece of surface that a column meets, and what follows from them.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "hybrid/tile_shapes.h"
#include "raytrace/packet/huge_array.h"

namespace gnomon::hybrid {

enum class Certainty : std::uint8_t { shadowed = 0, lit = 1, unsure = 2 };

/// A texel that stays in doubt when it is refined is split into parts_per_side^2 columns.
inline constexpr int parts_per_side = 4;

/// Room for tiles' texels, in large pages: what receivers look up lies all over the map.
class TexelStore {
 public:
  TexelBounds* take();  ///< a tile's, without values; by any thread

 private:
  std::mutex mutex_;
  std::vector<raytrace::HugeArray<TexelBounds>> blocks_;
  std::size_t left_ = 0;  // tiles in the last block
};

/// All texels alike (the slope then counts from the tile's centre), or one by one, row by row.
struct SheetTile {
  TexelBounds uniform = empty_texel;
  TexelBounds* texels = nullptr;                                        ///< in a TexelStore; null: all alike
  static constexpr std::uint16_t not_split = 0xffff, refined = 0xfffe;  ///< refined: and not split
  std::unique_ptr<std::uint16_t[]>
      split_of;                    ///< of each texel, its place among the split ones; null: none refined
  std::vector<TexelBounds> parts;  ///< of the split ones, row by row
  /// For the texel that holds (u, v), counted from the tile's corner.
  Certainty at(double u, double v, double nearness) const;
  struct Part {
    const TexelBounds* bounds;
    double from_middle_u, from_middle_v;  ///< of the receiver, in texels
    Certainty judge(double nearness, double doubt) const;
  };
  /// Where a place 0 ... 1 in a texel lies, of a tile with split_of.
  Part part_of(std::size_t texel, double in_u, double in_v) const;
  bool is_refined(std::size_t texel) const { return split_of && split_of[texel] != not_split; }
  std::uint64_t bytes() const;
};

/// `doubt`: of the nearness, beyond that of GridPoint's.
inline Certainty judge(const TexelBounds& bounds, double from_middle_u, double from_middle_v, double nearness,
                       double doubt = 0.0) {
  const double n = nearness - (static_cast<double>(bounds.slope_u) * from_middle_u +
                               static_cast<double>(bounds.slope_v) * from_middle_v);
  return n - doubt > static_cast<double>(bounds.lit_above)    ? Certainty::lit
         : n + doubt < static_cast<double>(bounds.dark_below) ? Certainty::shadowed
                                                              : Certainty::unsure;
}

inline Certainty SheetTile::Part::judge(double nearness, double doubt) const {
  return hybrid::judge(*bounds, from_middle_u, from_middle_v, nearness, doubt);
}

inline SheetTile::Part SheetTile::part_of(std::size_t texel, double in_u, double in_v) const {
  if (split_of[texel] >= refined) return {&unsure_texel, 0.0, 0.0};
  const auto part = [](double in) {
    return std::min(static_cast<int>(in * parts_per_side), parts_per_side - 1);
  };
  const int i = part(in_u), j = part(in_v);
  const auto place = static_cast<std::size_t>((split_of[texel] * parts_per_side + j) * parts_per_side + i);
  return {&parts[place], in_u - (i + 0.5) / parts_per_side, in_v - (j + 0.5) / parts_per_side};
}

inline Certainty SheetTile::at(double u, double v, double nearness) const {
  if (!texels) return judge(uniform, u - 0.5 * tile_texels, v - 0.5 * tile_texels, nearness);
  const int x = static_cast<int>(u), y = static_cast<int>(v), texel = y * tile_texels + x;
  const double in_u = u - x, in_v = v - y;
  const Certainty whole = judge(texels[texel], in_u - 0.5, in_v - 0.5, nearness);
  if (whole != Certainty::unsure || !split_of) return whole;
  return part_of(static_cast<std::size_t>(texel), in_u, in_v).judge(nearness, 0.0);
}

/// Builds tiles one after the other; one per task, for it keeps its buffers.
class TileBuilder : private PieceRelations {
 public:
  /// `points`: every vertex of the world on this face. All must outlive the builder.
  TileBuilder(const World& world, const raytrace::Topology& topology, const SheetGrid& grid,
              const std::vector<TriangleFacing>& facing, int face, const std::vector<GridPoint>& points,
              TexelStore& store)
      : world_(world),
        topology_(topology),
        grid_(grid),
        facing_(facing),
        face_(face),
        points_(points),
        store_(store) {}

  /// `triangles`: all that may meet the tile. Shapes are found here.
  SheetTile build(int tile_x, int tile_y, std::span<const std::uint32_t> triangles);
  /// Solves these texels of a tile again, by sheets and in parts: slower, and less is unsure.
  void refine(int tile_x, int tile_y, std::span<const std::uint32_t> triangles,
              std::span<const std::uint16_t> texels, SheetTile& tile);

  std::uint64_t pieces() const { return piece_count_; }

 private:
  struct Placed {
    std::uint32_t texel;
    Piece piece;
  };
  void add_triangle(const TileTriangle& triangle);
  void add_texel(const TileTriangle& triangle, int x, int y);
  void add_shapes(int tile_x, int tile_y);
  /// anywhere_inside: a body of unknown shape that the sphere holds.
  void add_sphere(const SphereColumns& sphere, bool anywhere_inside);
  void place(int x, int y, const Piece& piece) {
    placed_.push_back({static_cast<std::uint32_t>(y * tile_texels + x), piece});
  }
  ColumnBounds covers_alone();
  bool apart(std::uint32_t a, std::uint32_t b) const override;
  void clip(Piece& piece, float slope_u, float slope_v) const override;
  std::uint32_t across(std::uint32_t triangle, int edge) const override {
    return topology_.across(triangle, edge);
  }
  bool lies_beside(std::uint32_t a, std::uint32_t b) const;
  TexelBounds widened(TexelBounds bounds) const;
  void finish(SheetTile& tile);
  /// The column of column_'s pieces.
  ColumnBounds solve(float x, float y, float half_texels, bool quick);
  void collect(int tile_x, int tile_y, std::span<const std::uint32_t> triangles);
  void sort_by_texel();
  void split(std::size_t texel, std::span<const Piece> pieces, SheetTile& tile);

  const World& world_;
  const raytrace::Topology& topology_;
  const SheetGrid& grid_;
  const std::vector<TriangleFacing>& facing_;
  int face_;
  const std::vector<GridPoint>& points_;
  TexelStore& store_;
  std::vector<Placed> placed_;
  std::vector<Cover> covers_;
  std::vector<std::uint32_t> first_;  // of each texel's pieces
  std::vector<Piece> sorted_, column_;
  std::vector<TileTriangle> kept_;                                 // by Piece::slot
  float column_x_ = 0.0f, column_y_ = 0.0f, column_reach_ = 0.0f;  // of the column that is being solved
  std::uint64_t piece_count_ = 0;
};

}  // namespace gnomon::hybrid
