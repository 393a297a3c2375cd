// What gnomon check found of each run, as a table, a page and a document.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "scene/base/expected.h"
#include "studies/diff/diff.h"

namespace gnomon::studies {

struct CheckedRun {
  enum class Outcome : std::uint8_t { kept, exceeded, failed } outcome = Outcome::kept;
  std::string name, scene;
  std::string why{};                             ///< what is exceeded, or why it failed
  std::optional<compare::LightFigures> worst{};  ///< of the light with most wrong pixels
  std::optional<Diff> diff{};                    ///< from the baseline's
  std::string limits{};                          ///< "wrong:1%, worse by 0.1%"
  bool was_there = false;                        ///< by --resume
  int code = 0;                                  ///< exit code
};

/// The pooled figures of each light of a result.json; at least one. ErrorKind::bad_input.
Expected<std::vector<compare::LightFigures>> light_figures(const std::string& result_json);

std::string check_table(const std::vector<CheckedRun>& runs);
/// Schema "gnomon/check/1" (docs/design.md).
std::string check_json(const std::vector<CheckedRun>& runs, const std::string& config);
/// DIR/report.html, whose links lead into each run's folder, and DIR/check.json; `json`: a file that gets the same.
Expected<void> write_check(const std::vector<CheckedRun>& runs, const std::string& config,
                           const std::string& folder, const std::string& json);

}  // namespace gnomon::studies
