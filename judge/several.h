// Several captures on one page and in one table, the worst first; each row opens its own report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "compare/result/result_table.h"
#include "scene/base/expected.h"

namespace gnomon::judge {

/// One capture, judged or refused. `compared` 0: judged, but its shares say nothing.
struct JudgedRow {
  std::string name;     ///< of its folder below that of all
  std::string refused;  ///< why it was not judged; the rest is then empty
  std::string scene, renderer, ladder, labels, advice;
  std::uint64_t compared = 0;
  double wrong = 0.0, mean_error = 0.0;    ///< shares of the compared pixels
  double edge_pixels = 0.0;                ///< RMS displacement of shadow edges
  std::optional<double> detachment_world;  ///< mean; none where no shadow stands off
};
JudgedRow judged_row(const std::string& name, const compare::Comparison& comparison);

/// What was judged so far: rows, the lines of judge.jsonl, the table of judge.csv.
struct JudgedSet {
  std::vector<JudgedRow> rows;
  std::string lines;
  compare::ResultTable table;
  void add(const std::string& name, const compare::Comparison& comparison);
  void add_refused(const std::string& name, const std::string& why);
};

/// At most 100 columns, for the terminal; the worst first, then those of which nothing was compared, refused ones last.
std::string judged_table(const JudgedSet& set);
/// report.html, judge.jsonl (one result.json a line, with "axes": {"capture": NAME}) and judge.csv.
Expected<void> write_judged_set(const JudgedSet& set, const std::string& folder);

}  // namespace gnomon::judge
