// The map of sheets of one light: for every texel two bounds that tell a receiver's hard shadow for sure, or
// leave it to a ray.
//
// Proof that what is sure is right. Let C be the column of light rays through one texel and x a receiver in
// it, on the surface of the scene. Every piece of surface that meets C is in C's list, for the list is made
// conservatively; so x lies on a piece of it. A *sheet* is a connected part of equally facing triangles
// inside C (raytrace/sheets/sheets.h). Suppose that no edge that ends it crosses C. Then its projection along the
// rays onto C's cross-section is a proper local homeomorphism (a branched one at vertices whose fan winds twice).
// Hence it is a covering of some degree d >= 1, the same over every point of the texel. It is counted over one
// point.
//  - Surely shadowed: a sheet without boundary lies wholly nearer to the light than x. d >= 1, so x's own ray
//    meets it, and before x.
//  - Surely lit: the nearest sheet F has no boundary and degree 1, and all others lie wholly behind x. Then x
//    cannot be on another one, so it is on F; and F meets x's ray once only, namely in x. Nothing else comes
//    before x. So no query of x's own primitive is needed: its reciprocal depth alone decides.
// Nothing in this depends on how fine the mesh is or how steep it stands, and there is no bias. Rounding only ever
// widens intervals and adds boundary, that is, adds "ambiguous". What is ambiguous is traced, so the result is the
// ray-traced hard shadow at every pixel. An alpha-masked triangle is boundary everywhere; glass casts shadows like
// any surface; facing-away receivers are not asked about.
//
// Related: Hertel, Hormann and Westermann 2009, "A hybrid GPU rendering pipeline for alias-free hard shadows"
// (conservative shadow maps: certain but for texels near edges, which are traced); Story 2015, "Hybrid ray
// traced shadows" (triangle lists in light texels, rays against them); Kern, Bruell and Grosch 2024, "Leak
// tracing" (1.2-1.8 times the speed of pure ray tracing, but not exact). They decide by depth and tolerance;
// the degree of a sheet needs neither.
#pragma once

#include <optional>

#include "hybrid/tile_sheets.h"
#include "raytrace/precision/error_bounds.h"
#include "raytrace/quantised_tile.h"

namespace gnomon::hybrid {

struct SheetStats {
  double build_ms = 0.0, refine_ms = 0.0;
  std::uint64_t bytes = 0;
  std::uint64_t detailed_tiles = 0;  ///< whose texels are kept one by one
  std::uint64_t pieces = 0;          ///< of surface met by columns
};

class LightSheets {
 public:
  /// The view is a light's; world and topology must outlive the sheets. Without build() they know of
  /// lone_plane() alone.
  LightSheets(const World& world, const raytrace::Topology& topology, const LightView& view);
  /// Once. In parallel; the same for any number of threads.
  void build();
  bool is_built() const { return !tiles_.empty(); }

  /// The part of a texel that a receiver looks up, if it lies on the map.
  std::optional<std::uint64_t> part_of(const Vec3& position) const;
  /// Looks closely at these parts and their texels, those that it had not before; returns how many. In
  /// parallel.
  std::size_t refine(std::vector<std::uint64_t> parts);

  /// Tells how certain the visibility of a receiver is that the light can reach, on the surface of the world.
  Certainty at(const Vec3& position, std::uint32_t primitive) const;

  const LightView& view() const { return grid_.view; }
  const SheetGrid& grid() const { return grid_; }
  const SheetStats& stats() const { return stats_; }
  const SheetTile& tile(std::size_t index) const { return tiles_[index]; }
  /// SheetTile::texels of the tiles from this one on, close together.
  const PackedBounds* const* texels_from(std::size_t tile) const { return texels_.data() + tile; }
  /// What a receiver beside the map is: everything but infinite planes lies inside, and this plane alone is
  /// there; no_id: nothing is known.
  std::uint32_t lone_plane() const { return lone_plane_; }

 private:
  /// What all tiles of a face are built from.
  struct Face {
    std::vector<ProjectedPoint> points;
    TileBins bins;
  };
  struct Place {  // of a receiver, in texels of its face
    int face;
    double u, v, reciprocal_depth;
  };
  std::optional<Place> place_of(const Vec3& position) const;
  void build_face(int face);
  std::uint32_t find_lone_plane() const;
  void count_tiles();

  const World& world_;
  const raytrace::Topology& topology_;
  SheetGrid grid_;
  std::vector<TriangleFacing> facing_;
  std::vector<Face> faces_;
  std::unique_ptr<TexelStore> store_ = std::make_unique<TexelStore>();
  std::vector<SheetTile> tiles_;
  std::vector<const PackedBounds*> texels_;  // of the tiles
  std::uint32_t lone_plane_ = no_id;
  SheetStats stats_;
};

inline std::optional<LightSheets::Place> LightSheets::place_of(const Vec3& position) const {
  if (!(raytrace::max_component(glm::abs(position)) < grid_.bounds.reach)) return std::nullopt;
  const int face =
      grid_.perspective && grid_.view.face_count == 6 ? cube_face(position - grid_.view.origin) : 0;
  const ProjectedPoint p = grid_.point(face, position);
  if (grid_.perspective && !(p.w > grid_.near_limit)) return std::nullopt;
  return Place{face, p.u / p.w, p.v / p.w, p.reciprocal_depth};
}

inline Certainty LightSheets::at(const Vec3& position, std::uint32_t primitive) const {
  const auto at = place_of(position);
  if (!at) return Certainty::ambiguous;
  const double size = grid_.view.size, u = at->u, v = at->v;
  if (!(u >= 0.0 && v >= 0.0 && u < size && v < size)) {
    constexpr double beside = 4.0 * texel_slack;
    const bool far = u < -beside || v < -beside || u > size + beside || v > size + beside;
    return far && primitive == lone_plane_ && primitive != no_id ? Certainty::lit : Certainty::ambiguous;
  }
  if (!is_built()) return Certainty::ambiguous;
  const int x = static_cast<int>(u) / tile_texels, y = static_cast<int>(v) / tile_texels;
  return tiles_[grid_.tile_index(at->face, x, y)].at(u - x * tile_texels, v - y * tile_texels,
                                                     at->reciprocal_depth);
}

// A picture tile's receivers against the sheets, eight at a time, from the compact floats. The texel and the
// reciprocal depth of each are in double. All that the floats' rounding can do is added to the errors. What floats
// leave open is for LightSheets::at.

using raytrace::LaneMask;

/// Classes the receivers that are there, as bits per packet, each receiver in one class.
struct TileClasses {
  LaneMask unreached;  ///< facing away from the light
  LaneMask lit, shadowed;
  LaneMask ambiguous;  ///< facing it, and the sheets cannot tell
  LaneMask open;       ///< to be asked in double: whether it faces the light, or what the sheets say
};

/// No spot lights: a cone is not looked at.
void classify_tile(const LightSheets& sheets, const Light& light, const raytrace::QuantisedTile& tile,
                   TileClasses& out);

}  // namespace gnomon::hybrid
