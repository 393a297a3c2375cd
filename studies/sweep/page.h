// The page of a sweep, from the same built page as that of a comparison: charts, a grid of thumbnails, the
// cells in the viewer, and a table of all cells with the command of each. Readable without scripts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/write_outputs.h"
#include "studies/sweep/headline.h"
#include "studies/sweep/ray_points.h"
#include "studies/sweep/summary.h"

namespace gnomon::compare {

/// What the folder holds of a cell's pictures (cell_files.h).
struct CellPictures {
  std::string thumbnail;  ///< PNG
  std::string data;       ///< JSON text
  std::string drawing;    ///< PNG; empty: the cell was not drawn
};

/// What the page is made of.
struct SweepPageInput {
  const SweepHeader& header;
  const std::vector<CellSummary>& cells;
  const std::map<std::size_t, CellPictures>& pictures;  ///< by cell
  const std::map<std::string, std::string>& truths;     ///< PNG by name
  const std::vector<RayPoint>& rays;                    ///< the ray tracer's own points; may be none
  bool beside = false;                                  ///< the pictures are files beside the page
  std::optional<Threshold> limit;  ///< of the error; its cheapest cell is named in the headline
};

/// The page as one file, or with the folder's files beside it.
std::string sweep_page(const SweepPageInput& input);

/// Tables of thumbnails, one per combination of the other axes: rows by the first axis, columns by the last.
/// `front` as below.
std::string thumbnail_grids(const SweepPageInput& input, const std::vector<std::size_t>& front);
/// The table of all cells; `front`: indices of those on the Pareto front.
std::string cell_table(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front);
/// What the page's script reads, and the parts of it that hold the cells' pictures.
std::string sweep_page_data(const SweepPageInput& input, const std::vector<std::size_t>& front);

struct WrittenPage {
  double page_mb = 0.0;  ///< what it weighs as one file
  bool beside = false;   ///< it was more than allowed
  Headline headline;
};
/// Writes DIR/report.html from what the folder holds. Errors are those of reading and writing.
Expected<WrittenPage> write_sweep_page(const std::string& folder,
                                       double report_max_mb = default_report_max_mb,
                                       const std::optional<Threshold>& limit = {});

}  // namespace gnomon::compare
