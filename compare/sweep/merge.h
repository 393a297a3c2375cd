// Shards of a sweep put together: the folder is then the one that a single process would have left, times
// aside.
#pragma once

#include <string>
#include <vector>

#include "scene/expected.h"

namespace gnomon::compare {

/// `folders`: every shard of one sweep, each finished, in any order. Returns the number of cells. Errors:
/// usage for shards that do not belong together, are missing or are not finished; those of reading and
/// writing.
Expected<std::size_t> merge_sweeps(const std::vector<std::string>& folders, const std::string& target);

}  // namespace gnomon::compare
