// Shards of a sweep put together: the folder is then the one that a single process would have left, times
// aside.
#pragma once

#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "studies/sweep/page.h"

namespace gnomon::compare {

struct MergedSweep {
  std::size_t cells = 0;
  WrittenPage page;
  std::vector<std::string> drawers;  ///< what drew the cells (drawer_of_line); more than one is worth a note
};

/// `folders`: every shard of one sweep, each finished, in any order. Errors:
/// usage for shards that do not belong together, are missing or are not finished; those of reading and
/// writing.
Expected<MergedSweep> merge_sweeps(const std::vector<std::string>& folders, const std::string& target,
                                   double report_max_mb = default_report_max_mb,
                                   const std::optional<Threshold>& limit = {});

}  // namespace gnomon::compare
