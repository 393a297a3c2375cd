// result.csv and sweep.csv: one row per light (and cell), from the text of result.json or a line of
// sweep.jsonl with its line of times. Columns are the keys of result.json joined with '_' ("error_wrong",
// "map_bias_slope", "budget_filter_signed", "times_ms_map_pass_median"). A sweep has before them "cell" (from
// 0), the axes ("axes_map_size"), the axes that have no effect there ("no_effect"), and with its times
// "derived", "cell_ms" and "load". RFC 4180: lines end with CR LF; a value that a row has not is empty.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gnomon::compare {

class ResultTable {
 public:
  using Json = nlohmann::ordered_json;
  /// Adds the rows of a comparison: result.json.
  void add(const Json& result);
  /// Adds the rows of a cell; `line` is a line of sweep.jsonl, `times` that of sweep_times.jsonl. Returns
  /// what is to be appended to the text so far, or nothing when a new column came up: then text() has to be
  /// written again.
  std::string add(std::size_t cell, const Json& line, const Json& times);
  /// The whole table with its head.
  std::string text() const;

 private:
  using Named = std::vector<std::pair<std::string, std::string>>;  // column, value
  using Row = std::vector<std::string>;                            // by column; later columns are empty
  std::string row_text(const Row& row) const;
  bool add_row(Named named);
  std::vector<std::string> columns_;
  std::unordered_map<std::string, std::size_t> places_;  // of the columns
  std::vector<Row> rows_;
};

}  // namespace gnomon::compare
