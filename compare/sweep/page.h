// The page of a sweep: one HTML file, offline, readable without scripts. Charts, a grid of thumbnails, and a
// table of all cells with the command of each.
#pragma once

#include <map>
#include <string>

#include "compare/sweep/summary.h"

namespace gnomon::compare {

/// PNG files by cell.
using Thumbnails = std::map<std::size_t, std::string>;

std::string sweep_page(const SweepHeader& header, const std::vector<CellSummary>& cells,
                       const Thumbnails& thumbnails);

/// One grid of thumbnails per combination of the other axes: rows by the first axis, columns by the last one.
std::string thumbnail_grids(const std::vector<CellSummary>& cells, const Thumbnails& thumbnails);

/// Writes DIR/report.html from what the folder holds. Errors are those of reading and writing.
Expected<void> write_sweep_page(const std::string& folder);

/// Where a cell's thumbnail is kept, and which cells of a sweep have one: all of them up to `max_thumbnails`,
/// else that many, evenly spread.
std::string thumbnail_path(const std::string& folder, std::size_t cell);
inline constexpr std::size_t max_thumbnails = 144;
bool has_thumbnail(std::size_t cell, std::size_t cells);

}  // namespace gnomon::compare
