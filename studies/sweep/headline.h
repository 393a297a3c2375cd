// What a sweep found, in words: the best cell for the error, for the time, for both, and the cheapest within
// a limit that was asked for.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "studies/sweep/summary.h"

namespace gnomon::studies {

/// One cell that is best, or that none is.
struct HeadlineItem {
  std::string title;                ///< "Best for error"; of no cell the whole sentence
  std::optional<std::size_t> cell;  ///< its number
  std::string setting, figures;  ///< "map size 1024, technique pcf"; "2.0 % wrong, mean error 2.0 %, 12 ms"
};

struct Headline {
  std::vector<HeadlineItem> items;
  bool limit_met = true;  ///< some cell is within the limit; true where none was asked for
  /// The items as whole sentences.
  std::vector<std::string> lines() const;
};

/// `front`: of pareto_front().
Headline sweep_headline(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                        const std::optional<compare::Threshold>& limit);

/// "map size 1024, technique pcf": the axes' values; "the only cell" without axes.
std::string axes_words(const CellSummary& cell);

// How a sweep speaks of its axes, values and labels: in words, not in keys of sweep.jsonl.

/// "map_size" -> "map size".
std::string axis_words(std::string_view axis);
/// A value as people read it: a number with five decimals or more at four significant digits, its unit behind it
/// ("0.00869565217391" -> "0.008696"); words without underscores. Commands and CSV have it in full.
std::string value_words(std::string_view value);
/// A label by its key of result.json: "peter_panning" -> "peter-panning"; empty for an empty key.
std::string label_words_of(std::string_view key);

}  // namespace gnomon::studies
