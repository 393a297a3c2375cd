// Uniform grid, walked by a 3D-DDA: Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray
// tracing". Here the DDA counts walls with integers and computes each wall's crossing afresh, so nothing
// drifts, and it keeps the range of cells in which the ray may be: where the order of two crossings is in
// doubt (a ray through an edge or a corner of cells), it passes through the cells on both sides.
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

struct Grid {
  CellBox bounds;
  std::array<int, 3> cells{0, 0, 0};
  std::array<std::vector<float>, 3> walls;  ///< cells[a] + 1 per axis, ascending
  std::vector<std::uint32_t>
      offsets;  ///< cell (x, y, z) holds items[offsets[i]] ... offsets[i + 1], i = (z ny + y) nx + x
  std::vector<std::uint32_t> items;  ///< ascending in each cell

  static constexpr std::uint64_t max_cells = std::uint64_t{1} << 24;
  static constexpr int max_cells_per_axis = 4096;

  std::span<const std::uint32_t> cell(int x, int y, int z) const {
    const std::size_t i =
        (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(y)) *
            static_cast<std::size_t>(cells[0]) +
        static_cast<std::size_t>(x);
    return std::span(items).subspan(offsets[i], offsets[i + 1] - offsets[i]);
  }
  std::uint64_t bytes() const {
    return (walls[0].size() + walls[1].size() + walls[2].size()) * sizeof(float) +
           (offsets.size() + items.size()) * sizeof(std::uint32_t);
  }
  std::uint64_t nodes() const { return offsets.empty() ? 0 : offsets.size() - 1; }
};

Grid build_grid(const CellItems& items, const GridOptions& options = {});

/// Where along one axis the ray may be: in cells first ... last, counted in the ray's direction.
class GridAxis {
 public:
  GridAxis(const Grid& grid, const BoxRay& ray, std::size_t axis, float begin)
      : walls_(grid.walls[axis].data()),
        ray_(&ray),
        axis_(axis),
        count_(grid.cells[axis]),
        backwards_(goes_backwards(ray, axis)) {
    // The bounds ascend with the cells, for every operation in them is monotone.
    int lo = 0, hi = count_ - 1;
    while (lo < hi) {
      const int middle = (lo + hi + 1) / 2;
      if (entry(middle) <= begin)
        lo = middle;
      else
        hi = middle - 1;
    }
    last_ = lo;
    for (lo = 0, hi = last_; lo < hi;) {
      const int middle = (lo + hi) / 2;
      if (exit(middle) >= begin)
        hi = middle;
      else
        lo = middle + 1;
    }
    first_ = lo;
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
  int first() const { return first_; }
  int last() const { return last_; }
  int place(int step) const { return backwards_ ? count_ - 1 - step : step; }  ///< the cell's own index

 private:
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

/// walk() of raytrace/traverse.h; `visit` is given places in the order of CellItems.
template <class Stats, class Visit>
bool walk(const Grid& grid, BoxRay& ray, Stats& stats, const Visit& visit) {
  if (grid.offsets.empty()) return false;
  const RaySpan span = clip(ray, grid.bounds);
  if (span.empty()) return false;
  Mailbox mailbox;
  std::array<GridAxis, 3> axes{GridAxis(grid, ray, 0, span.begin), GridAxis(grid, ray, 1, span.begin),
                               GridAxis(grid, ray, 2, span.begin)};
  // The cells of the current ranges, along `only` just the last one: those not visited before.
  const auto visit_cells = [&](std::size_t only) {
    const auto first = [&](std::size_t a) { return a == only ? axes[a].last() : axes[a].first(); };
    for (int z = first(2); z <= axes[2].last(); ++z)
      for (int y = first(1); y <= axes[1].last(); ++y)
        for (int x = first(0); x <= axes[0].last(); ++x) {
          stats.boxes(1);
          if (visit_cell(grid.cell(axes[0].place(x), axes[1].place(y), axes[2].place(z)), mailbox, stats,
                         visit))
            return true;
        }
    return false;
  };
  if (visit_cells(3)) return true;
  for (;;) {
    std::size_t in = 0, out = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (axes[a].next_entry < axes[in].next_entry) in = a;
      if (axes[a].next_exit < axes[out].next_exit) out = a;
    }
    const float entry = axes[in].next_entry, exit = axes[out].next_exit;
    const float next = std::min(entry, exit);
    if (!(next <= std::min(span.end, ray.t_max)) || next > FLT_MAX) return false;
    if (entry <= exit) {  // enter before leaving: a tie belongs to both cells
      axes[in].enter_next();
      if (visit_cells(in)) return true;
    } else if (!axes[out].leave_first()) {
      return false;
    }
  }
}

}  // namespace gnomon::raytrace
