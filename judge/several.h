// Several captures on one page and in one table, the worst first; each row opens its own report.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "compare/result/result_table.h"
#include "scene/base/expected.h"

namespace gnomon::judge {

/// One capture, judged or refused. Without compared pixels it is judged, but its figures say nothing.
struct JudgedRow {
  std::string name;     ///< of its folder below that of all
  std::string refused;  ///< why it was not judged; the rest is then empty
  std::string scene, renderer, ladder, labels, advice;
  compare::LightFigures figures;
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
