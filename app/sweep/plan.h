// Which cells of a sweep a process makes.
#pragma once

#include <string>
#include <vector>

#include "compare/result/output_parts.h"
#include "studies/sweep/axis.h"
#include "studies/sweep/journal.h"

namespace gnomon::app {

/// The cells of a shard, and what the journal must know of each.
struct Plan {
  compare::Grid grid;
  std::vector<std::size_t> cells;
  std::vector<std::string> axes;
};

/// Names and values of a cell.
compare::AxisValues axis_values(const compare::Grid& grid, std::size_t cell);

/// The same names, of the axes that have no effect on a cell.
std::vector<std::string> json_names(std::vector<std::string> axes);

Plan make_plan(compare::Grid grid, compare::Shard shard);

}  // namespace gnomon::app
