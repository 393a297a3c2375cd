#include "hybrid/texel_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hybrid/packed_bounds.h"

namespace gnomon::hybrid {
namespace {

/// Groups with more pieces are not asked whether they lie apart.
constexpr std::size_t most_members = 6;

/// Pieces that hang together, or may.
struct Group {
  float low = inf, high = -inf;
  int degree = 0;
  bool boundary = false, open = false;
  Facing facing = Facing::edge_on;
  std::size_t count = 0;
  std::array<std::uint32_t, most_members> triangles{};

  bool overlaps(const Piece& piece) const { return open && piece.high >= low; }
  void start(const Piece& piece) {
    low = inf, high = piece.high;
    degree = 0, count = 0;
    boundary = false, open = true;
    facing = piece.facing;
    add(piece);
  }
  void add(const Piece& piece) {
    low = std::min(low, piece.low), high = std::max(high, piece.high);
    degree += piece.covers ? 1 : 0;
    boundary = boundary || piece.boundary;
    if (count < most_members) triangles[count] = piece.triangle;
    ++count;
  }
  bool beside() const { return !boundary && degree == 0; }
  bool shadows_itself(const PieceRelations& relations) const {
    if (!boundary && degree == 1) return false;
    if (facing == Facing::edge_on || count > most_members) return true;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j)
        if (!relations.apart(triangles[i], triangles[j])) return true;
    return false;
  }
};

/// What the groups say together; they come in no order.
class ColumnSummary {
 public:
  void take(const Group& group) {
    if (!group.open || group.beside()) return;
    if (!group.boundary) dark_below_ = std::max(dark_below_, group.low);
    if (!first_.open || group.high > first_.high) {
      second_high_ = first_.high;
      first_ = group;
    } else {
      second_high_ = std::max(second_high_, group.high);
    }
  }
  ColumnBounds bounds(const PieceRelations& relations) const {
    if (!first_.open) return {};
    if (first_.shadows_itself(relations)) return {{inf, dark_below_, 0.0f, 0.0f}, false};
    return {{second_high_, dark_below_, 0.0f, 0.0f}, second_high_ < first_.low};
  }

 private:
  Group first_;
  float second_high_ = -inf, dark_below_ = -inf;
};

void sort_by_falling_high(std::span<Piece> pieces) {
  constexpr std::size_t few = 16;
  const auto before = [](const Piece& a, const Piece& b) { return a.high > b.high; };
  if (pieces.size() > few) {
    std::sort(pieces.begin(), pieces.end(), before);
    return;
  }
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece piece = pieces[i];
    std::size_t at = i;
    for (; at > 0 && before(piece, pieces[at - 1]); --at) pieces[at] = pieces[at - 1];
    pieces[at] = piece;
  }
}

/// The usual column: of each facing, all pieces share some reciprocal depth, so they are one group.
bool one_group_each(std::span<const Piece> pieces, std::array<Group, 3>& groups) {
  std::array<float, 3> most_low{-inf, -inf, -inf}, least_high{inf, inf, inf};
  for (const Piece& piece : pieces) {
    const auto facing = static_cast<std::size_t>(piece.facing);
    if (groups[facing].open)
      groups[facing].add(piece);
    else
      groups[facing].start(piece);
    most_low[facing] = std::max(most_low[facing], piece.low);
    least_high[facing] = std::min(least_high[facing], piece.high);
  }
  return most_low[0] <= least_high[0] && most_low[1] <= least_high[1] && most_low[2] <= least_high[2];
}

/// Groups by overlap, as pieces come by falling `high`.
ColumnBounds by_overlap(std::span<Piece> pieces, const PieceRelations& relations) {
  if (std::array<Group, 3> groups; one_group_each(pieces, groups)) {
    ColumnSummary summary;
    for (const Group& group : groups) summary.take(group);
    return summary.bounds(relations);
  }
  sort_by_falling_high(pieces);
  std::array<Group, 3> open;  // by facing
  ColumnSummary summary;
  for (const Piece& piece : pieces) {
    Group& group = open[static_cast<std::size_t>(piece.facing)];
    if (group.overlaps(piece)) {
      group.add(piece);
      continue;
    }
    summary.take(group);
    group.start(piece);
  }
  for (const Group& group : open) summary.take(group);
  return summary.bounds(relations);
}

/// Sheets by their edges, as raytrace::ColumnSheets finds them.
class EdgeSheets {
 public:
  EdgeSheets(std::span<Piece> pieces, const PieceRelations& relations)
      : pieces_(pieces), relations_(relations) {
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece& a, const Piece& b) { return a.triangle < b.triangle; });
    for (std::uint32_t i = 0; i < pieces.size(); ++i) pieces[i].parent = i;
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      for (int k = 0; k < 3; ++k)
        if ((pieces[i].crossing >> k & 1) != 0) join(i, relations.across(pieces[i].triangle, k));
  }

  ColumnBounds evaluate() {
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) pieces_[i].parent = root(i);
    std::sort(pieces_.begin(), pieces_.end(),
              [](const Piece& a, const Piece& b) { return a.parent < b.parent; });
    ColumnSummary summary;
    for (std::size_t i = 0; i < pieces_.size();) {
      Group group;
      group.start(pieces_[i]);
      std::size_t end = i + 1;
      for (; end < pieces_.size() && pieces_[end].parent == pieces_[i].parent; ++end) group.add(pieces_[end]);
      summary.take(group);
      i = end;
    }
    return summary.bounds(relations_);
  }

 private:
  std::uint32_t root(std::uint32_t i) {
    while (pieces_[i].parent != i) i = pieces_[i].parent = pieces_[pieces_[i].parent].parent;
    return i;
  }
  void join(std::uint32_t i, std::uint32_t triangle) {
    const auto at = std::lower_bound(pieces_.begin(), pieces_.end(), triangle,
                                     [](const Piece& p, std::uint32_t id) { return p.triangle < id; });
    if (at == pieces_.end() || at->triangle != triangle) {
      pieces_[i].boundary = true;  // lists are conservative, so this is rounding's work: it ends here
      return;
    }
    const std::uint32_t a = root(i), b = root(static_cast<std::uint32_t>(at - pieces_.begin()));
    pieces_[std::max(a, b)].parent = std::min(a, b);
  }

  std::span<Piece> pieces_;
  const PieceRelations& relations_;
};

/// The nearest piece over the sample point whose plane is known, or null.
const Piece* front_of(std::span<const Piece> pieces) {
  const Piece* front = nullptr;
  for (const Piece& piece : pieces)
    if (piece.covers && piece.error < inf && (front == nullptr || piece.middle > front->middle))
      front = &piece;
  return front;
}

/// relations: narrow the pieces to the column as well.
void subtract_slopes(float slope_u, float slope_v, float half_texels, const PieceRelations* relations,
                     std::span<Piece> pieces) {
  const float most = half_texels * (std::abs(slope_u) + std::abs(slope_v));
  for (Piece& p : pieces) {
    p.low -= most, p.high += most;
    if (!(p.error < inf)) continue;
    const float spread = half_texels * (std::abs(p.slope_u - slope_u) + std::abs(p.slope_v - slope_v)) +
                         p.error + 0x1p-20f * most;
    p.low = std::max(p.low, p.middle - spread), p.high = std::min(p.high, p.middle + spread);
    if (relations != nullptr && p.slot != Piece::no_slot) relations->clip(p, slope_u, slope_v);
  }
}

}  // namespace

namespace {

/// Takes the slope of the nearest surface off, and puts it back into the answer.
template <class Solve>
ColumnBounds without_slope(std::span<Piece> pieces, float half_texels, const PieceRelations* relations,
                           const Solve& solve) {
  float u = 0.0f, v = 0.0f;
  if (const Piece* front = front_of(pieces)) u = round_slope(front->slope_u), v = round_slope(front->slope_v);
  subtract_slopes(u, v, half_texels, relations, pieces);
  ColumnBounds found = solve();
  found.bounds.slope_u = u, found.bounds.slope_v = v;
  return found;
}

bool is_better(const ColumnBounds& a, const ColumnBounds& b) {
  return a.decisive || (b.bounds.lit_above == inf && a.bounds.lit_above < inf);
}

}  // namespace

ColumnBounds quick_bounds_of(std::span<Piece> pieces, float half_texels, const PieceRelations& relations) {
  const ColumnBounds plain = by_overlap(pieces, relations);
  if (plain.decisive || front_of(pieces) == nullptr) return plain;
  const ColumnBounds sloped =
      without_slope(pieces, half_texels, nullptr, [&] { return by_overlap(pieces, relations); });
  return is_better(sloped, plain) ? sloped : plain;
}

ColumnBounds bounds_of(std::span<Piece> pieces, float half_texels, const PieceRelations& relations) {
  const ColumnBounds plain = by_overlap(pieces, relations);
  if (plain.decisive) return plain;
  const ColumnBounds sheets = without_slope(pieces, half_texels, &relations,
                                            [&] { return EdgeSheets(pieces, relations).evaluate(); });
  return is_better(sheets, plain) ? sheets : plain;
}

}  // namespace gnomon::hybrid
