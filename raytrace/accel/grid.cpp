#include "raytrace/accel/grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

// References per primitive (and a floor for small scenes) before the grid is made coarser: huge primitives
// among many cells must not cost more memory than the scene.
constexpr std::uint64_t references_per_item = 16, references_at_least = std::uint64_t{1} << 20;

struct CellReference {
  std::uint32_t cell, item;
};

/// Cubes of equal volume that add up to density * count; an axis thinner than one cube gets one cell and
/// leaves the number to the others.
std::array<int, 3> resolution(const CellItems& items, double density) {
  const double wanted = std::min(density * items.count(), static_cast<double>(UniformGrid::max_cells));
  std::array<std::size_t, 3> order{0, 1, 2};
  const CellBox& box = items.bounds();
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return box.extent(a) < box.extent(b); });
  std::array<int, 3> cells{1, 1, 1};
  if (!std::isfinite(box.extent(order[2]))) return cells;
  double left = std::max(1.0, wanted);
  for (std::size_t i = 0; i < 3; ++i) {
    double ratio = left;  // of the remaining cells to the remaining cubes of this axis' extent
    for (std::size_t j = i; j < 3; ++j) ratio *= box.extent(order[i]) / box.extent(order[j]);
    const double count = std::pow(ratio, 1.0 / static_cast<double>(3 - i));
    const double whole =
        std::clamp(std::round(count), 1.0, static_cast<double>(UniformGrid::max_cells_per_axis));
    cells[order[i]] = static_cast<int>(whole);
    left = std::max(1.0, left / whole);
  }
  while (static_cast<std::uint64_t>(cells[0]) * static_cast<std::uint64_t>(cells[1]) *
             static_cast<std::uint64_t>(cells[2]) >
         UniformGrid::max_cells)
    --*std::max_element(cells.begin(), cells.end());
  return cells;
}

std::vector<float> walls_along(float min, float max, int cells) {
  std::vector<float> walls(static_cast<std::size_t>(cells) + 1);
  const double lo = min, size = static_cast<double>(max) - lo;
  for (int i = 0; i <= cells; ++i)
    walls[static_cast<std::size_t>(i)] = std::clamp(static_cast<float>(lo + size * i / cells), min, max);
  walls.front() = min, walls.back() = max;
  return walls;
}

struct CellRange {
  int first, last;
};

CellRange cells_of(const std::vector<float>& walls, float min, float max) {
  const auto begin = walls.begin() + 1, end = walls.end() - 1;  // cell i lies between walls i and i + 1
  return {static_cast<int>(std::lower_bound(begin, end, min) - begin),
          static_cast<int>(std::upper_bound(begin, end, max) - begin)};
}

/// The cells that one primitive may reach into, slab by slab and row by row so that most are never looked at.
template <class Add>
void for_each_cell(const UniformGrid& grid, const CellItems& items, std::uint32_t item, const Add& add) {
  const BoxRef& box = items.box(item);
  std::array<CellRange, 3> range;
  for (std::size_t a = 0; a < 3; ++a) range[a] = cells_of(grid.walls[a], box.min[a], box.max[a]);
  CellBox cell{box.min, box.max};
  const auto intersects = [&](std::size_t axis, int i, const CellRange& whole) {
    if (whole.first == whole.last) return true;
    cell.min[axis] = grid.walls[axis][static_cast<std::size_t>(i)];
    cell.max[axis] = grid.walls[axis][static_cast<std::size_t>(i) + 1];
    return items.may_overlap(item, cell);
  };
  for (int z = range[2].first; z <= range[2].last; ++z) {
    cell = {box.min, box.max};
    if (!intersects(2, z, range[2])) continue;
    for (int y = range[1].first; y <= range[1].last; ++y) {
      cell.min[0] = box.min[0], cell.max[0] = box.max[0];
      if (!intersects(1, y, range[1])) continue;
      for (int x = range[0].first; x <= range[0].last; ++x)
        if (intersects(0, x, range[0]) &&
            !add(static_cast<std::uint32_t>((z * grid.cells[1] + y) * grid.cells[0] + x)))
          return;
    }
  }
}

/// What a sample of the items promises for all of them.
std::uint64_t estimate_references(const UniformGrid& grid, const CellItems& items) {
  constexpr std::uint32_t sample = 256;
  const std::uint32_t step = (items.count() + sample - 1) / sample;
  std::uint64_t found = 0;
  for (std::uint32_t item = 0; item < items.count(); item += step)
    for_each_cell(grid, items, item, [&](std::uint32_t) { return ++found != 0; });
  return found * step;
}

/// By blocks of items; false when there are more than `limit`, and then the blocks are incomplete.
bool find_references(const UniformGrid& grid, const CellItems& items, std::uint64_t limit,
                     std::vector<std::vector<CellReference>>& blocks) {
  constexpr std::uint32_t block = 512;
  blocks.assign((items.count() + block - 1) / block, {});
  std::atomic<std::uint64_t> total = 0;
  parallel_for(blocks.size(), [&](std::size_t b) {
    const auto begin = static_cast<std::uint32_t>(b) * block, end = std::min(items.count(), begin + block);
    for (std::uint32_t item = begin; item < end; ++item)
      for_each_cell(grid, items, item, [&](std::uint32_t cell) {
        blocks[b].push_back({cell, item});
        return total.fetch_add(1, std::memory_order_relaxed) < limit;
      });
  });
  return total <= limit;
}

void fill(UniformGrid& grid, const std::vector<std::vector<CellReference>>& blocks) {
  const std::size_t cells = static_cast<std::size_t>(grid.cells[0]) *
                            static_cast<std::size_t>(grid.cells[1]) * static_cast<std::size_t>(grid.cells[2]);
  grid.offsets.assign(cells + 1, 0);
  for (const auto& block : blocks)
    for (const CellReference& r : block) ++grid.offsets[r.cell + 1];
  for (std::size_t i = 0; i < cells; ++i) grid.offsets[i + 1] += grid.offsets[i];
  grid.items.resize(grid.offsets[cells]);
  grid.occupied.assign((cells + 63) / 64, 0);
  for (std::size_t i = 0; i < cells; ++i)
    if (grid.offsets[i + 1] > grid.offsets[i]) grid.occupied[i / 64] |= std::uint64_t{1} << (i % 64);
  std::vector<std::uint32_t> next(grid.offsets.begin(), grid.offsets.end() - 1);
  for (const auto& block : blocks)
    for (const CellReference& r : block) grid.items[next[r.cell]++] = r.item;
}

}  // namespace

UniformGrid build_grid(const CellItems& items, const GridOptions& options) {
  UniformGrid grid;
  if (items.count() == 0) return grid;
  grid.bounds = items.bounds();
  grid.cells = resolution(items, options.density);
  const std::uint64_t limit = std::max(references_at_least, references_per_item * items.count());
  std::vector<std::vector<CellReference>> blocks;
  for (;;) {
    for (std::size_t a = 0; a < 3; ++a)
      grid.walls[a] = walls_along(grid.bounds.min[a], grid.bounds.max[a], grid.cells[a]);
    if (estimate_references(grid, items) <= limit && find_references(grid, items, limit, blocks)) break;
    for (int& n : grid.cells) n = std::max(1, n / 2);
  }
  fill(grid, blocks);
  return grid;
}

}  // namespace gnomon::raytrace
