// sweep.csv: one row per cell and light, from the lines of sweep.jsonl. Columns are the keys of result.json
// joined with '_' ("error_wrong", "map_bias_slope", "budget_filter_signed"), after "cell" (from 0), the axes
// ("axes_map_size"), the axes that have no effect there ("no_effect") and the light. RFC 4180: lines end with
// CR LF; a value that a row has not is empty.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon::compare {

class SweepTable {
 public:
  /// Adds the rows of a cell; `line` is a line of sweep.jsonl. Returns what is to be appended to the text so
  /// far, or nothing when a new column came up: then text() has to be written anew.
  std::string add(std::size_t cell, std::string_view line);
  /// The whole table with its head.
  std::string text() const;

 private:
  using Row = std::vector<std::pair<std::string, std::string>>;  // column, value
  std::string row_text(const Row& row) const;
  bool add_columns(const Row& row);
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace gnomon::compare
