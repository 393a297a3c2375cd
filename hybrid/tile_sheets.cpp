#include "hybrid/tile_sheets.h"

#include "raytrace/precision/error_bounds.h"

namespace gnomon::hybrid {
namespace {

constexpr std::size_t texel_count = std::size_t{tile_texels} * tile_texels;
constexpr float slack = static_cast<float>(texel_slack);

//// The texels' sample point, from their centres: off every line that scenes' own symmetry could lay through
/// texels.
constexpr float sample_x = 0.0137f, sample_y = -0.0291f;

constexpr Cover anything{{}, inf, -inf, inf, Facing::edge_on, true};

bool overlaps(const std::array<float, 4>& box, float x, float y, float half) {
  return box[0] <= x + half && box[1] >= x - half && box[2] <= y + half && box[3] >= y - half;
}

/// The triangle in the square of 2 x half around (x, y), the column; nothing: it surely misses.
std::optional<Piece> piece_at(const TileTriangle& t, float x, float y, float half) {
  Piece piece{.low = t.low,
              .high = t.high,
              .facing = t.facing,
              .boundary = (t.boundary & TriangleFacing::whole) != 0,
              .covers = true,
              .triangle = t.id,
              .slot = t.slot};
  const float reach = half + 2.0f * slack;
  bool ambiguous = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const float edge = t.edge[k].at(x, y), margin = reach + t.error[k];
    if (edge < -margin) return std::nullopt;
    // Edge-on: nothing lies farther from the edge than the corner across it.
    if (t.facing == Facing::edge_on && edge > t.depth[k] + margin) return std::nullopt;
    if (edge <= margin && overlaps(t.box[k], x, y, half)) {
      if ((t.boundary >> k & 1) != 0)
        piece.boundary = true;
      else
        piece.crossing |= static_cast<std::uint8_t>(1U << k);
    }
    const float at_sample = edge + 2.0f * half * (t.edge[k].u * sample_x + t.edge[k].v * sample_y);
    if (at_sample < -t.error[k])
      piece.covers = false;
    else if (!(at_sample > t.error[k]))
      ambiguous = true;
  }
  if (ambiguous && piece.covers) piece.boundary = true;
  if (!(t.reciprocal_depth_error < inf)) return piece;
  piece.middle = t.reciprocal_depth.at(x, y);
  piece.slope_u = t.reciprocal_depth.u, piece.slope_v = t.reciprocal_depth.v,
  piece.error = t.reciprocal_depth_error;
  const float spread =
      reach * (std::abs(t.reciprocal_depth.u) + std::abs(t.reciprocal_depth.v)) + t.reciprocal_depth_error;
  piece.low = std::max(piece.low, piece.middle - spread);
  piece.high = std::min(piece.high, piece.middle + spread);
  return piece;
}

constexpr float half_part = 0.5f / parts_per_side;

/// Where it is false, no part in the square of 2 x half around (x, y) meets the triangle, neither in truth nor in floats.
/// The edge's value here and its value at a part are rounded apart: by that no more than 2^-21 of their sizes is lost.
bool may_intersect_parts(const TileTriangle& t, float x, float y, float half) {
  const float to_part = half - half_part;
  for (std::size_t k = 0; k < 3; ++k) {
    const float edge = t.edge[k].at(x, y), rounding = 0x1p-20f * (std::abs(edge) + 2.0f * tile_texels);
    if (edge + to_part * (std::abs(t.edge[k].u) + std::abs(t.edge[k].v)) <
        -(half_part + 2.0f * slack + t.error[k] + rounding))
      return false;
  }
  return true;
}

struct Polygon {
  std::array<Vec2, 8> corner;
  std::size_t count = 0;
};

/// Sutherland and Hodgman 1974.
Polygon clip_to_square(const std::array<Vec2, 3>& triangle, const Vec2& center, double half) {
  Polygon part{{triangle[0], triangle[1], triangle[2]}, 3};
  for (int plane = 0; plane < 4 && part.count > 0; ++plane) {
    const int axis = plane / 2;
    const double sign = plane % 2 == 0 ? 1.0 : -1.0;
    const auto inside = [&](const Vec2& p) { return sign * (p[axis] - center[axis]) + half; };
    Polygon next;
    for (std::size_t i = 0; i < part.count; ++i) {
      const Vec2 &a = part.corner[i], &b = part.corner[(i + 1) % part.count];
      const double va = inside(a), vb = inside(b);
      if (va >= 0.0 && next.count < next.corner.size()) next.corner[next.count++] = a;
      if ((va >= 0.0) != (vb >= 0.0) && next.count < next.corner.size())
        next.corner[next.count++] = a + (va / (va - vb)) * (b - a);
    }
    part = next;
  }
  return part;
}

}  // namespace

PackedBounds* TexelStore::take() {
  constexpr std::size_t tiles = 1024;  // 8 MiB, so that they are large pages
  const std::lock_guard lock(mutex_);
  if (left_ == 0) blocks_.emplace_back(tiles * texel_count), left_ = tiles;
  return blocks_.back().data() + --left_ * texel_count;
}

std::uint64_t SheetTile::bytes() const {
  return (texels ? texel_count * sizeof(PackedBounds) : 0) + looks.size() * sizeof(Look) + parts.bytes();
}

SheetTile TileBuilder::build(int tile_x, int tile_y, std::span<const std::uint32_t> triangles) {
  collect(tile_x, tile_y, triangles);
  piece_count_ += placed_.size() + covers_.size();
  SheetTile tile;
  if (placed_.empty()) {
    const ColumnBounds all = covers_alone();
    tile.uniform = pack(all.bounds);
    const bool alike =
        std::none_of(covers_.begin(), covers_.end(), [](const Cover& c) { return c.error < inf; });
    if (all.decisive || covers_.size() == 1 || alike) return tile;
  }
  finish(tile);
  return tile;
}

void TileBuilder::collect(int tile_x, int tile_y, std::span<const std::uint32_t> triangles) {
  placed_.clear(), covers_.clear(), kept_.clear();
  const TileFrame frame(grid_, face_, tile_x, tile_y);
  TileTriangle triangle;
  for (const std::uint32_t id : triangles) {
    const auto v = world_.triangle(id);
    if (!frame.set_up({points_[v[0]], points_[v[1]], points_[v[2]]}, facing_[id], triangle)) continue;
    triangle.id = id;
    if (TileFrame::covers_tile(triangle)) {
      covers_.push_back({triangle.reciprocal_depth, triangle.reciprocal_depth_error, triangle.low,
                         triangle.high, triangle.facing, (triangle.boundary & TriangleFacing::whole) != 0,
                         id});
      continue;
    }
    triangle.slot = static_cast<std::uint32_t>(kept_.size());
    kept_.push_back(triangle);
    add_triangle(triangle);
  }
  add_shapes(tile_x, tile_y);
}

void TileBuilder::add_triangle(const TileTriangle& t) {
  for (int y = t.y0; y <= t.y1; ++y)
    for (int x = t.x0; x <= t.x1; ++x)
      if (is_wanted(x, y)) add_texel(t, x, y);
}

void TileBuilder::add_texel(const TileTriangle& t, int x, int y) {
  const auto fx = static_cast<float>(x) + 0.5f, fy = static_cast<float>(y) + 0.5f;
  if (const auto piece = piece_at(t, fx, fy, 0.5f)) place(x, y, *piece);
}

void TileBuilder::clip(Piece& piece, float slope_u, float slope_v) const {
  const TileTriangle& t = kept_[piece.slot];
  if (t.clipped) return;
  const auto du = static_cast<double>(piece.slope_u - slope_u),
             dv = static_cast<double>(piece.slope_v - slope_v);
  const double x = static_cast<double>(column_x_), y = static_cast<double>(column_y_);
  const auto inside = clip_to_square(t.corner, Vec2(x, y), static_cast<double>(column_reach_));
  if (inside.count == 0) return;  // only rounding put it here
  double low = infinity, high = -infinity;
  for (std::size_t i = 0; i < inside.count; ++i) {
    const double value = du * (inside.corner[i].x - x) + dv * (inside.corner[i].y - y);
    low = std::min(low, value), high = std::max(high, value);
  }
  const double middle = static_cast<double>(piece.middle);
  const double rounding = static_cast<double>(piece.error) +
                          2.0 * texel_slack * (std::abs(du) + std::abs(dv)) + 0x1p-22 * std::abs(middle);
  piece.low = std::max(piece.low, raytrace::float_below(middle + low - rounding));
  piece.high = std::min(piece.high, raytrace::float_above(middle + high + rounding));
}

void TileBuilder::add_shapes(int tile_x, int tile_y) {
  for (std::uint32_t id = world_.triangle_count(); id < world_.primitive_count(); ++id) {
    const Shape& shape = world_.shape(id);
    const bool masked = world_.is_masked(id);
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      if (const auto cover = plane_cover(grid_, face_, tile_x, tile_y, *plane, masked))
        covers_.push_back(*cover);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      const SphereColumns columns(grid_, face_, tile_x, tile_y, *sphere, masked);
      if (!columns.is_everywhere()) {
        add_sphere(columns);
        continue;
      }
      const ShapeGeometry ball = make_ellipsoid(ShapeFrame{.origin = sphere->center}, Vec3(sphere->radius));
      add_solid(SolidColumns(grid_, face_, tile_x, tile_y, ball, masked));
    } else {
      add_solid(SolidColumns(grid_, face_, tile_x, tile_y, shape.geometry, masked));
    }
  }
}

void TileBuilder::add_sphere(const SphereColumns& sphere) {
  if (sphere.misses_tile()) return;
  for (int y = 0; y < tile_texels; ++y)
    for (int x = 0; x < tile_texels; ++x) {
      if (!is_wanted(x, y)) continue;
      if (const auto sides = sphere.at(x, y))
        for (const Piece& side : *sides) place(x, y, side);
    }
}

void TileBuilder::add_solid(const SolidColumns& solid) {
  constexpr int block = 8;  // texels
  if (solid.is_everywhere()) covers_.push_back(anything);
  if (solid.is_everywhere() || solid.misses_tile() || solid.misses(0, 0, tile_texels)) return;
  for (int y0 = 0; y0 < tile_texels; y0 += block)
    for (int x0 = 0; x0 < tile_texels; x0 += block) {
      if (solid.misses(x0, y0, block)) continue;
      for (int y = y0; y < y0 + block; ++y)
        for (int x = x0; x < x0 + block; ++x) {
          if (!is_wanted(x, y)) continue;
          const SolidColumns::Pieces pieces = solid.at(x, y);
          for (int i = 0; i < pieces.count; ++i) place(x, y, pieces.piece[static_cast<std::size_t>(i)]);
        }
    }
}

// One triangle lies wholly on the outer side of an edge of the other. Corners that they share lie on it.
bool TileBuilder::apart(std::uint32_t a, std::uint32_t b) const {
  if (a == no_id || b == no_id) return false;
  return lies_beside(a, b) || lies_beside(b, a);
}

bool TileBuilder::lies_beside(std::uint32_t a, std::uint32_t b) const {
  const auto va = world_.triangle(a), vb = world_.triangle(b);
  const auto first = world_.corners(a), second = world_.corners(b);
  std::array<Vec2, 3> p, q;
  double error = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const ProjectedPoint &i = points_[va[k]], &j = points_[vb[k]];
    if (!(std::min(i.w, j.w) > grid_.near_limit)) return false;
    p[k] = Vec2(i.u, i.v) / i.w, q[k] = Vec2(j.u, j.v) / j.w;
    error = std::max(error, 2.0 * grid_.grid_error / std::min(i.w, j.w));
  }
  const double inside = -facing_[a].facing * grid_.faces[static_cast<std::size_t>(face_)].handedness;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t end = (k + 1) % 3;
    const Vec2 edge = p[end] - p[k];
    bool beside = true;
    for (std::size_t c = 0; c < 3 && beside; ++c) {
      if (second[c] == first[k] || second[c] == first[end]) continue;
      const Vec2 to = q[c] - p[k];
      const double value = edge.x * to.y - edge.y * to.x;
      const double sizes = std::abs(edge.x) + std::abs(edge.y) + std::abs(to.x) + std::abs(to.y);
      beside = inside * value < -(4.0 * error * (sizes + error) + 0x1p-50 * sizes * sizes);
    }
    if (beside) return true;
  }
  return false;
}

// The whole tile as one column.
ColumnBounds TileBuilder::covers_alone() {
  constexpr float middle = 0.5f * tile_texels;
  column_.clear();
  return solve(middle, middle, middle, false);
}

ColumnBounds TileBuilder::solve(float x, float y, float half, bool quick) {
  column_x_ = x, column_y_ = y, column_reach_ = half + 2.0f * slack;
  for (const Cover& cover : covers_) {
    const Piece piece = cover.at(x, y, column_reach_);
    if (piece.low <= piece.high) column_.push_back(piece);  // else: beyond a plane's horizon
  }
  ColumnBounds found =
      quick ? quick_bounds_of(column_, column_reach_, *this) : bounds_of(column_, column_reach_, *this);
  found.bounds = widened(found.bounds);
  return found;
}

TexelBounds TileBuilder::widened(TexelBounds b) const {
  // A receiver's place in the texel is known within the slack.
  const float by_slope = 2.0f * slack * (std::abs(b.slope_u) + std::abs(b.slope_v));
  b.lit_above += by_slope, b.dark_below -= by_slope;
  if (std::isfinite(b.lit_above))
    b.lit_above += static_cast<float>(grid_.reciprocal_depth_error(b.lit_above));
  if (std::isfinite(b.dark_below))
    b.dark_below -= static_cast<float>(grid_.reciprocal_depth_error(b.dark_below));
  return b;
}

// A counting sort; afterwards first_[i] is where the texel's pieces end.
void TileBuilder::sort_by_texel() {
  first_.assign(texel_count + 1, 0);
  for (const Placed& p : placed_) ++first_[p.texel + 1];
  for (std::size_t i = 0; i < texel_count; ++i) first_[i + 1] += first_[i];
  sorted_.resize(placed_.size());
  for (const Placed& p : placed_) sorted_[first_[p.texel]++] = p.piece;
}

namespace {

float middle_of(std::size_t texel) {
  return static_cast<float>(texel) + 0.5f;
}

/// Returns the middle of a piece of the texel that is 2 x half wide.
float middle_of(std::uint32_t texel, std::uint32_t step, float half) {
  return static_cast<float>(texel) + (2.0f * static_cast<float>(step) + 1.0f) * half;
}

}  // namespace

void TileBuilder::finish(SheetTile& tile) {
  sort_by_texel();
  tile.texels = store_.take();
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < texel_count; ++i) {
    column_.assign(sorted_.begin() + begin, sorted_.begin() + first_[i]);
    begin = first_[i];
    tile.texels[i] = pack(solve(middle_of(i % tile_texels), middle_of(i / tile_texels), 0.5f, true).bounds);
  }
}

std::span<const Piece> TileBuilder::pieces_in(std::size_t texel) const {
  return {sorted_.data() + (texel > 0 ? first_[texel - 1] : 0), sorted_.data() + first_[texel]};
}

void TileBuilder::refine(int tile_x, int tile_y, std::span<const std::uint32_t> triangles,
                         std::span<const std::uint32_t> parts, SheetTile& tile) {
  using Look = SheetTile::Look;
  if (tile.texels == nullptr) {
    collect(tile_x, tile_y, triangles);
    finish(tile);
  }
  wanted_.assign(texel_count, false);
  for (const std::uint32_t part : parts) wanted_[part / parts_per_texel] = true;
  collect(tile_x, tile_y, triangles);
  sort_by_texel();
  if (tile.looks.empty()) tile.looks.assign(texel_count, Look::quick);
  for (Block& block : blocks_) block.key = no_block;
  for (const std::uint32_t part : parts) {
    const std::size_t texel = part / parts_per_texel;
    Look& look = tile.looks[texel];
    if (look == Look::quick) {
      const auto pieces = pieces_in(texel);
      column_.assign(pieces.begin(), pieces.end());
      const ColumnBounds found =
          solve(middle_of(texel % tile_texels), middle_of(texel / tile_texels), 0.5f, false);
      tile.texels[texel] = pack(found.bounds);
      look = found.decisive ? Look::decided : Look::by_sheets;
    }
    if (!tile.is_known(part)) tile.parts.insert(part, solve_part(part));
  }
  wanted_.clear();
}

// A coarse texel holds thousands of triangles, and a block of its parts few of them. Parts come row by row: the blocks of
// a row are kept.
std::span<const Piece> TileBuilder::pieces_near(std::uint32_t part) {
  const std::uint32_t texel = part / parts_per_texel, in_texel = part % parts_per_texel;
  const std::uint32_t bx = in_texel % parts_per_side / block_parts,
                      by = in_texel / parts_per_side / block_parts;
  Block& block = blocks_[bx];
  if (const std::uint32_t key = texel * blocks_per_side + by; block.key != key) {
    constexpr float half = 0.5f / blocks_per_side;
    const float x = middle_of(texel % tile_texels, bx, half), y = middle_of(texel / tile_texels, by, half);
    block.key = key;
    block.pieces.clear();
    for (const Piece& piece : pieces_in(texel))
      if (piece.slot == Piece::no_slot || may_intersect_parts(kept_[piece.slot], x, y, half))
        block.pieces.push_back(piece);
  }
  return block.pieces;
}

PackedBounds TileBuilder::solve_part(std::uint32_t part) {
  const std::uint32_t texel = part / parts_per_texel, in_texel = part % parts_per_texel;
  const float x = middle_of(texel % tile_texels, in_texel % parts_per_side, half_part);
  const float y = middle_of(texel / tile_texels, in_texel / parts_per_side, half_part);
  column_.clear();
  for (const Piece& piece : pieces_near(part)) {
    if (piece.slot == Piece::no_slot)
      column_.push_back(piece);
    else if (const auto there = piece_at(kept_[piece.slot], x, y, half_part))
      column_.push_back(*there);
  }
  return pack(solve(x, y, half_part, false).bounds);
}

}  // namespace gnomon::hybrid
