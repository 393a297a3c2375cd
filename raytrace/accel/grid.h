// Uniform grid, traversed by a 3D-DDA: Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray
// tracing". Here the DDA counts walls with integers and computes each wall's crossing afresh, so nothing
// drifts. It keeps the range of cells in which the ray may be. Where the order of two crossings is ambiguous
// (a ray through an edge or a corner of cells), it passes through the cells on both sides. Where it is not
// ambiguous, as nearly always, it steps from cell to cell.
//
// How many cells: about `density` per primitive, cube-shaped (Cleary and Wyvill 1988, "Analysis of an
// algorithm for fast ray tracing using uniform space subdivision"). The textbook's rule is three cells per
// axis and cube root of the count, hence 27 per primitive. Fewer are better for meshes; see grid.cpp.
#pragma once

#include <optional>

#include "raytrace/accel/crossing.h"

namespace gnomon::raytrace {

struct GridOptions {
  double density = 8.0;  ///< cells per primitive, > 0
  static constexpr double textbook_density = 27.0;
};

struct UniformGrid {
  CellBox bounds;
  std::array<int, 3> cells{0, 0, 0};
  std::array<std::vector<float>, 3> walls;  ///< cells[a] + 1 per axis, ascending
  std::vector<std::uint32_t>
      offsets;  ///< cell (x, y, z) holds items[offsets[i]] ... offsets[i + 1], i = (z ny + y) nx + x
  std::vector<std::uint64_t> occupied;  ///< a bit per cell: most are empty, and the bits fit into a cache
  std::vector<std::uint32_t> items;     ///< ascending in each cell

  static constexpr std::uint64_t max_cells = std::uint64_t{1} << 24;
  static constexpr int max_cells_per_axis = 4096;

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cells[0]) +
           static_cast<std::size_t>(x);
  }
  bool is_occupied(std::size_t cell) const { return (occupied[cell / 64] >> (cell % 64) & 1) != 0; }
  std::span<const std::uint32_t> cell(std::size_t i) const {
    return std::span(items).subspan(offsets[i], offsets[i + 1] - offsets[i]);
  }
  std::uint64_t bytes() const {
    return (walls[0].size() + walls[1].size() + walls[2].size()) * sizeof(float) +
           (offsets.size() + items.size()) * sizeof(std::uint32_t) + occupied.size() * sizeof(occupied[0]);
  }
  std::uint64_t nodes() const { return offsets.empty() ? 0 : offsets.size() - 1; }
};

UniformGrid build_grid(const CellItems& items, const GridOptions& options = {});

/// Where along one axis the ray may be: in cells first ... last, counted in the ray's direction.
class GridAxis {
 public:
  GridAxis(const UniformGrid& grid, const BoxRay& ray, std::size_t axis, float begin)
      : walls_(grid.walls[axis].data()),
        ray_(&ray),
        axis_(axis),
        count_(grid.cells[axis]),
        backwards_(goes_backwards(ray, axis)) {
    // The bounds ascend with the cells, for every operation in them is monotone.
    last_ = guess(begin);
    while (last_ + 1 < count_ && entry(last_ + 1) <= begin) ++last_;
    while (last_ > 0 && !(entry(last_) <= begin)) --last_;
    first_ = last_;
    while (first_ > 0 && exit(first_ - 1) >= begin) --first_;
    find_next_entry(), find_next_exit();
  }

  float next_entry, next_exit;  ///< when the ray may enter one more cell; when it has surely left the first
  void enter_next() { ++last_, find_next_entry(); }
  /// False when that was the last cell of all.
  bool leave_first() {
    if (++first_ >= count_) return false;
    find_next_exit();
    return true;
  }
  /// Both at once, of a ray that is in one cell alone.
  void step() { ++first_, ++last_, find_next_entry(), find_next_exit(); }
  bool is_backwards() const { return backwards_; }
  int first() const { return first_; }
  int last() const { return last_; }
  int place(int step) const { return backwards_ ? count_ - 1 - step : step; }  ///< the cell's own index

 private:
  /// The cell where the ray is at t = begin, but for rounding; any cell where that is not a number.
  int guess(float begin) const {
    const float at = ray_->near_origin[axis_] + begin / ray_->inverse[axis_];
    const float cell = (at - walls_[0]) / (walls_[count_] - walls_[0]) * static_cast<float>(count_);
    const int whole = cell > 0.0f ? static_cast<int>(std::min(cell, static_cast<float>(count_ - 1))) : 0;
    return backwards_ ? count_ - 1 - whole : whole;
  }
  float entry(int step) const { return entry_bound(*ray_, axis_, walls_[backwards_ ? count_ - step : step]); }
  float exit(int step) const {
    return exit_bound(*ray_, axis_, walls_[backwards_ ? count_ - 1 - step : step + 1]);
  }
  void find_next_entry() {
    next_entry = last_ + 1 < count_ ? entry(last_ + 1) : std::numeric_limits<float>::infinity();
  }
  void find_next_exit() { next_exit = exit(first_); }

  const float* walls_;
  const BoxRay* ray_;
  std::size_t axis_;
  int count_, first_ = 0, last_ = 0;
  bool backwards_;
};

/// A ray on its way through the cells.
template <class Stats, class Visit>
class GridTraversal {
 public:
  GridTraversal(const UniformGrid& grid, const BoxRay& ray, const RaySpan& span, Stats& stats,
                const Visit& visit)
      : grid_(grid),
        ray_(ray),
        end_(span.end),
        stats_(stats),
        visit_(visit),
        axes_{GridAxis(grid, ray, 0, span.begin), GridAxis(grid, ray, 1, span.begin),
              GridAxis(grid, ray, 2, span.begin)},
        stride_{1, grid.cells[0], static_cast<std::ptrdiff_t>(grid.cells[0]) * grid.cells[1]} {
    for (std::size_t a = 0; a < 3; ++a)
      if (axes_[a].is_backwards()) stride_[a] = -stride_[a];
  }

  bool run() {
    if (visit_cells(none)) return true;
    for (;;) {
      std::size_t in = 0, out = 0;
      for (std::size_t a = 1; a < 3; ++a) {
        if (axes_[a].next_entry < axes_[in].next_entry) in = a;
        if (axes_[a].next_exit < axes_[out].next_exit) out = a;
      }
      const float entry = axes_[in].next_entry, exit = axes_[out].next_exit;
      const float next = std::min(entry, exit);
      if (!(next <= std::min(end_, ray_.t_max)) || next > FLT_MAX) return false;
      if (in_one_cell_ && entry <= exit && goes_straight(in)) {
        axes_[in].step();
        cell_ += stride_[in];
        if (visit_cell_at(static_cast<std::size_t>(cell_))) return true;
      } else if (entry <= exit) {  // enter before leaving: a tie belongs to both cells
        axes_[in].enter_next();
        if (visit_cells(in)) return true;
      } else if (!axes_[out].leave_first()) {
        return false;
      } else {
        find_cell();
      }
    }
  }

 private:
  static constexpr std::size_t none = 3;

  /// The wall ahead on this axis is surely behind the ray before it comes to any other.
  bool goes_straight(std::size_t axis) const {
    const float passed = axes_[axis].next_exit;
    return passed < axes_[(axis + 1) % 3].next_entry && passed < axes_[(axis + 2) % 3].next_entry;
  }
  /// The cells of the current ranges, along `only` just the last one: those not visited before.
  bool visit_cells(std::size_t only) {
    const auto first = [&](std::size_t a) { return a == only ? axes_[a].last() : axes_[a].first(); };
    for (int z = first(2); z <= axes_[2].last(); ++z)
      for (int y = first(1); y <= axes_[1].last(); ++y)
        for (int x = first(0); x <= axes_[0].last(); ++x)
          if (visit_cell_at(grid_.index(axes_[0].place(x), axes_[1].place(y), axes_[2].place(z))))
            return true;
    find_cell();
    return false;
  }
  bool visit_cell_at(std::size_t cell) {
    stats_.boxes(1);
    return grid_.is_occupied(cell) && visit_cell(grid_.cell(cell), mailbox_, stats_, visit_);
  }
  void find_cell() {
    in_one_cell_ = true;
    for (const GridAxis& axis : axes_) in_one_cell_ = in_one_cell_ && axis.first() == axis.last();
    cell_ = static_cast<std::ptrdiff_t>(grid_.index(axes_[0].place(axes_[0].first()),
                                                    axes_[1].place(axes_[1].first()),
                                                    axes_[2].place(axes_[2].first())));
  }

  const UniformGrid& grid_;
  const BoxRay& ray_;
  float end_;
  Stats& stats_;
  const Visit& visit_;
  Mailbox mailbox_;
  std::array<GridAxis, 3> axes_;
  std::array<std::ptrdiff_t, 3> stride_;  ///< of one cell, in the ray's direction
  bool in_one_cell_ = false;
  std::ptrdiff_t cell_ = 0;  ///< that one
};

/// traverse() of raytrace/bvh/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool traverse(const UniformGrid& grid, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (grid.offsets.empty()) return false;
  const RaySpan span = clip(ray, grid.bounds);
  return !span.empty() && GridTraversal<Stats, Visit>(grid, ray, span, stats, visit).run();
}

}  // namespace gnomon::raytrace
