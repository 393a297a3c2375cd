// The texels of one tile: every piece of surface that a column meets, and what follows from them.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hybrid/sheet_grid.h"
#include "hybrid/solid_columns.h"
#include "hybrid/texel_parts.h"
#include "hybrid/tile_shapes.h"
#include "raytrace/huge_array.h"

namespace gnomon::hybrid {

enum class Certainty : std::uint8_t { shadowed = 0, lit = 1, ambiguous = 2 };

/// Room for tiles' texels, in large pages: what receivers look up lies all over the map.
class TexelStore {
 public:
  PackedBounds* take();  ///< a tile's, without values; by any thread

 private:
  std::mutex mutex_;
  std::vector<raytrace::HugeArray<PackedBounds>> blocks_;
  std::size_t left_ = 0;  // tiles in the last block
};

/// All texels alike (the slope then counts from the tile's centre), or one by one, row by row.
struct SheetTile {
  PackedBounds uniform = pack(empty_texel);
  PackedBounds* texels = nullptr;  ///< in a TexelStore; null: all alike
  /// Says for each texel how closely it has been looked at; empty: none closely.
  enum class Look : std::uint8_t { quick, by_sheets, decided };  ///< decided: parts would tell no more
  std::vector<Look> looks;
  TexelParts parts;
  /// For the texel that holds (u, v), counted from the tile's corner.
  Certainty at(double u, double v, double reciprocal_depth) const;
  /// For a place 0 ... 1 in a texel that leaves it ambiguous, of a tile with parts.
  Certainty in_parts(std::uint32_t texel, double in_u, double in_v, double reciprocal_depth,
                     double error) const;
  /// The part's place in `parts`.
  template <class Float>
  static std::uint32_t part_at(std::uint32_t texel, Float in_u, Float in_v);
  /// For the place in the texel and the part's step along it.
  template <class Float>
  static Float from_middle_of_part(Float in_texel, std::uint32_t step) {
    return in_texel - (static_cast<Float>(step) + Float(0.5)) / parts_per_side;
  }
  /// Asking for this part would change nothing.
  bool is_known(std::uint32_t part) const;
  std::uint64_t bytes() const;
};

/// `error`: of the reciprocal depth, beyond that of ProjectedPoint's.
inline Certainty judge(const PackedBounds& packed, double from_middle_u, double from_middle_v,
                       double reciprocal_depth, double error = 0.0) {
  const TexelBounds bounds = unpack(packed);
  const double n = reciprocal_depth - (static_cast<double>(bounds.slope_u) * from_middle_u +
                                       static_cast<double>(bounds.slope_v) * from_middle_v);
  return n - error > static_cast<double>(bounds.lit_above)    ? Certainty::lit
         : n + error < static_cast<double>(bounds.dark_below) ? Certainty::shadowed
                                                              : Certainty::ambiguous;
}

template <class Float>
std::uint32_t SheetTile::part_at(std::uint32_t texel, Float in_u, Float in_v) {
  const auto step = [](Float in) {
    return static_cast<std::uint32_t>(std::min(static_cast<int>(in * parts_per_side), parts_per_side - 1));
  };
  return texel * parts_per_texel + step(in_v) * parts_per_side + step(in_u);
}

inline Certainty SheetTile::in_parts(std::uint32_t texel, double in_u, double in_v, double reciprocal_depth,
                                     double error) const {
  const std::uint32_t part = part_at(texel, in_u, in_v);
  const PackedBounds* bounds = parts.find(part);
  if (bounds == nullptr) return Certainty::ambiguous;
  return judge(*bounds, from_middle_of_part(in_u, part % parts_per_side),
               from_middle_of_part(in_v, part / parts_per_side % parts_per_side), reciprocal_depth, error);
}

inline bool SheetTile::is_known(std::uint32_t part) const {
  if (looks.empty()) return false;
  const Look look = looks[part / parts_per_texel];
  return look == Look::decided || (look == Look::by_sheets && !parts.empty() && parts.find(part) != nullptr);
}

inline Certainty SheetTile::at(double u, double v, double reciprocal_depth) const {
  if (!texels) return judge(uniform, u - 0.5 * tile_texels, v - 0.5 * tile_texels, reciprocal_depth);
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const auto texel = static_cast<std::uint32_t>(y * tile_texels + x);
  const double in_u = u - x, in_v = v - y;
  const Certainty whole = judge(texels[texel], in_u - 0.5, in_v - 0.5, reciprocal_depth);
  return whole != Certainty::ambiguous || parts.empty() ? whole
                                                        : in_parts(texel, in_u, in_v, reciprocal_depth, 0.0);
}

/// Builds tiles one after the other; one per task, for it keeps its buffers.
class TileBuilder : private PieceRelations {
 public:
  /// `points`: every vertex of the world on this face. All must outlive the builder.
  TileBuilder(const World& world, const raytrace::Topology& topology, const SheetGrid& grid,
              const std::vector<TriangleFacing>& facing, int face, const std::vector<ProjectedPoint>& points,
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
  /// Solves these parts of texels (ascending, as TexelParts has them) and the texels again, by sheets:
  /// slower, and less is ambiguous.
  void refine(int tile_x, int tile_y, std::span<const std::uint32_t> triangles,
              std::span<const std::uint32_t> parts, SheetTile& tile);

  std::uint64_t pieces() const { return piece_count_; }

 private:
  struct Placed {
    std::uint32_t texel;
    Piece piece;
  };
  static constexpr std::uint32_t block_parts = 8, blocks_per_side = parts_per_side / block_parts,
                                 no_block = ~0U;
  /// Parts of a texel, 8 x 8 of them, and the pieces that they may meet.
  struct Block {
    std::uint32_t key = no_block;  ///< the texel times blocks_per_side, and the row of blocks
    std::vector<Piece> pieces;
  };
  void add_triangle(const TileTriangle& triangle);
  void add_texel(const TileTriangle& triangle, int x, int y);
  void add_shapes(int tile_x, int tile_y);
  void add_sphere(const SphereColumns& sphere);
  void add_solid(const SolidColumns& solid);
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
  std::span<const Piece> pieces_in(std::size_t texel) const;
  PackedBounds solve_part(std::uint32_t part);
  /// The texel's pieces without most of those that surely miss the part.
  std::span<const Piece> pieces_near(std::uint32_t part);
  bool is_wanted(int x, int y) const {
    return wanted_.empty() ||
           wanted_[static_cast<std::size_t>(y) * tile_texels + static_cast<std::size_t>(x)];
  }

  const World& world_;
  const raytrace::Topology& topology_;
  const SheetGrid& grid_;
  const std::vector<TriangleFacing>& facing_;
  int face_;
  const std::vector<ProjectedPoint>& points_;
  TexelStore& store_;
  std::vector<bool> wanted_;  // texels; empty: all
  std::vector<Placed> placed_;
  std::vector<Cover> covers_;
  std::vector<std::uint32_t> first_;  // of each texel's pieces
  std::vector<Piece> sorted_, column_;
  std::array<Block, blocks_per_side> blocks_;
  std::vector<TileTriangle> kept_;                                 // by Piece::slot
  float column_x_ = 0.0f, column_y_ = 0.0f, column_reach_ = 0.0f;  // of the column that is being solved
  std::uint64_t piece_count_ = 0;
};

// Which triangles may meet which tile of one face of the map: a counting sort over all threads.

class TileBins {
 public:
  TileBins(const World& world, const SheetGrid& grid, const std::vector<ProjectedPoint>& points);
  /// Ascending ids. `tile`: row by row on the face.
  std::span<const std::uint32_t> triangles(std::size_t tile) const {
    return {triangles_.data() + first_[tile], triangles_.data() + first_[tile + 1]};
  }

  std::uint64_t bytes() const {
    return first_.size() * sizeof(std::uint64_t) + triangles_.size() * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint64_t> first_;  // of each tile
  std::vector<std::uint32_t> triangles_;
};

}  // namespace gnomon::hybrid
