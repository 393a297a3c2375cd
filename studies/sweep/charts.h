// The sweep page's drawings as inline SVG, styled by report.css and sweep.css.
#pragma once

#include <string>
#include <vector>

#include "studies/sweep/ray_points.h"
#include "studies/sweep/summary.h"

namespace gnomon::compare {

/// Wrong pixels against milliseconds, both on logarithmic scales: every timed cell, the front, and the ray
/// tracer. Errors of less than half a pixel in all that were compared stand on the lowest line, named "none".
/// Empty when nothing is timed.
/// `rays`: the ray tracer's own points; without them one stands for it, at the time that the cells' truth
/// took.
std::string pareto_chart(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                         const std::vector<RayPoint>& rays = {});

/// Wrong pixels against map size, log-log, a line for each technique with its best cell of each size, beside
/// the slope -1 of a pure sampling error. Empty with fewer than three sizes.
std::string size_chart(const std::vector<CellSummary>& cells);

/// A cell as a point that leads to it.
std::string cell_point(const CellSummary& cell, std::string_view kind, double x, double y, double radius,
                       const std::string& title);

}  // namespace gnomon::compare
