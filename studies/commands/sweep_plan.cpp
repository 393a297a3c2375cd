#include "studies/commands/sweep_command.h"

#include <algorithm>

#include "raster/settings.h"

namespace gnomon::app {
namespace {

/// Cells that differ from the one before in the constant bias alone stay with it: they come from one drawing.
bool shares_drawing(const studies::Grid& grid, std::size_t cell) {
  if (cell == 0) return false;
  const std::vector<std::size_t> a = grid.position(cell - 1), b = grid.position(cell);
  for (std::size_t k = 0; k < a.size(); ++k)
    if (grid.axes()[k].name != "bias" && a[k] != b[k]) return false;
  return true;
}

/// How many cells in a row have one truth: those that differ in options of the map alone.
std::size_t cells_of_one_truth(const studies::Grid& grid) {
  if (grid.zipped()) return 1;
  std::size_t cells = 1;
  for (std::size_t k = grid.axes().size(); k-- > 0;) {
    if (raster::find_setting(grid.axes()[k].name) == nullptr) break;
    cells *= grid.axes()[k].values.size();
  }
  return cells;
}

/// Shards take turns: at truths where these come out even, so that no truth is traced twice; else at
/// drawings.
bool shares_by_truth(const studies::Grid& grid, const studies::Shard& shard) {
  const std::size_t truths = grid.cells() / cells_of_one_truth(grid), of = static_cast<std::size_t>(shard.of);
  return truths > 1 && (truths % of == 0 || truths >= 8 * of);
}

}  // namespace

std::vector<std::string> json_names(std::vector<std::string> axes) {
  for (std::string& name : axes) std::replace(name.begin(), name.end(), '-', '_');
  return axes;
}

compare::AxisValues axis_values(const studies::Grid& grid, std::size_t cell) {
  compare::AxisValues values;
  const std::vector<std::size_t> at = grid.position(cell);
  for (std::size_t k = 0; k < at.size(); ++k) {
    std::string name = grid.axes()[k].name;
    std::replace(name.begin(), name.end(), '-', '_');
    values.emplace_back(std::move(name), grid.axes()[k].values[at[k]]);
  }
  return values;
}

Plan make_plan(studies::Grid grid, studies::Shard shard) {
  Plan plan{std::move(grid), {}, {}};
  const bool by_truth = shares_by_truth(plan.grid, shard);
  const std::size_t truth_cells = cells_of_one_truth(plan.grid);
  int drawing = -1;
  for (std::size_t cell = 0; cell < plan.grid.cells(); ++cell) {
    if (!shares_drawing(plan.grid, cell)) ++drawing;
    const int turn = by_truth ? static_cast<int>(cell / truth_cells) : drawing;
    if (turn % shard.of + 1 != shard.part) continue;
    plan.cells.push_back(cell);
    plan.axes.push_back(compare::axes_text(axis_values(plan.grid, cell)));
  }
  return plan;
}

}  // namespace gnomon::app
