#include "raytrace/sheets/column_sheets.h"

namespace gnomon::raytrace {

// Sheets but for the last one are whole, so that what is not known yet is on a new one.
bool ColumnSheets::same(std::uint32_t a, std::uint32_t b) {
  grow_until_met(a);
  if (!first_.contains(a)) begin(a);
  const std::uint32_t first = first_.at(a);
  if (first == queue_[0].triangle) grow_until_met(b);
  const auto found = first_.find(b);
  return found != first_.end() && found->second == first;
}

ColumnSheets::Piece ColumnSheets::piece(std::uint32_t triangle) const {
  const auto corners = world_.corners(triangle);
  Piece out{
      triangle, {column_.vertex(corners[0]), column_.vertex(corners[1]), column_.vertex(corners[2])}, 0};
  if (!column_.surely_misses(out.corners)) out.facing = column_.facing(out.corners);
  return out;
}

void ColumnSheets::begin(std::uint32_t triangle) {
  first_.emplace(triangle, triangle);
  queue_.assign(1, piece(triangle));
  next_ = queue_[0].facing == 0 ? 1 : 0;
}

void ColumnSheets::grow_until_met(std::uint32_t triangle) {
  while (next_ < queue_.size() && !first_.contains(triangle)) add_neighbours(Piece(queue_[next_++]));
}

void ColumnSheets::add_neighbours(const Piece& from) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t across = topology_.across(from.triangle, static_cast<int>(k));
    if (across >= Topology::non_manifold || first_.contains(across)) continue;
    if (column_.surely_misses(from.corners[k], from.corners[(k + 1) % 3])) continue;
    const Piece next = piece(across);
    if (next.facing != from.facing) continue;
    first_.emplace(across, queue_[0].triangle);
    queue_.push_back(next);
  }
}

}  // namespace gnomon::raytrace
