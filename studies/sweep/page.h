// The page of a sweep: its document, thumbnails of its cells, and the pictures that the page's viewer shows.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/write_outputs.h"
#include "scene/base/expected.h"
#include "studies/sweep/headline.h"
#include "studies/sweep/ray_points.h"
#include "studies/sweep/summary.h"

namespace gnomon::studies {

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
  std::optional<compare::Threshold> limit;  ///< of the error; its cheapest cell is named in the headline
};

/// The page as one file, or with the folder's files beside it.
std::string sweep_page(const SweepPageInput& input);

/// What the page shows, as JSON text.
std::string sweep_document(const SweepPageInput& input);

struct WrittenPage {
  double page_mb = 0.0;  ///< what it weighs as one file
  bool beside = false;   ///< it was more than allowed
  Headline headline;
};
/// Writes DIR/report.html from what the folder holds. Errors are those of reading and writing.
Expected<WrittenPage> write_sweep_page(const std::string& folder,
                                       double report_max_mb = report::default_report_max_mb,
                                       const std::optional<compare::Threshold>& limit = {});

// Shards of a sweep put together: the folder is then the one that a single process would have left, times
// aside.

struct MergedSweep {
  std::size_t cells = 0;
  WrittenPage page;
  std::vector<std::string> drawers;  ///< what drew the cells (drawer_of_line); more than one is worth a note
};

/// `folders`: every shard of one sweep, each finished, in any order. Errors:
/// usage for shards that do not belong together, are missing or are not finished; those of reading and
/// writing.
Expected<MergedSweep> merge_sweeps(const std::vector<std::string>& folders, const std::string& target,
                                   double report_max_mb = report::default_report_max_mb,
                                   const std::optional<compare::Threshold>& limit = {});

}  // namespace gnomon::studies
