// What a sweep found, in words: the best cell for the error, for the time, for both, and the cheapest within
// a limit that was asked for.
#pragma once

#include <optional>

#include "compare/sweep/summary.h"

namespace gnomon::compare {

struct Headline {
  std::vector<std::string> lines;  ///< whole sentences
  bool limit_met = true;           ///< some cell is within the limit; true where none was asked for
};

/// `front`: of pareto_front().
Headline sweep_headline(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                        const std::optional<Threshold>& limit);

/// "1,024 texels, technique pcf": the axes' values; "the only cell" without axes.
std::string axes_words(const CellSummary& cell);

}  // namespace gnomon::compare
