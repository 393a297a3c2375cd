// What the tuner found on one page to print: the answer and two rivals with as much memory for their maps. Each has the
// place where it errs most beside the truth, its figures, how sure they are, and the settings.
#pragma once

#include <string>
#include <vector>

#include "studies/sweep/engine.h"
#include "studies/tune/tune.h"

namespace gnomon::studies {

struct SheetCandidate {
  std::string name;          ///< "slope bias 1"
  std::string command;       ///< of compare, at the setting
  compare::Setting setting;  ///< its runs say how often it is timed
};

struct SheetInput {
  std::string scene;
  const TuneGoal& goal;
  std::string_view engine;                 ///< the one whose settings are given; empty: those of all
  std::vector<SheetCandidate> candidates;  ///< the answer first
};

/// The largest of the sizes at which a map of the attempt's kind takes no more bytes than so many; the least one where none
/// does. `sizes`: ascending, not empty.
int size_at_memory(const Attempt& attempt, const std::vector<int>& sizes, std::uint64_t bytes);

/// The attempt at its size with the bias that is best there by its gaps; as it is where gaps do not tell.
Expected<Attempt> attempt_at(Engine& engine, const compare::Setting& base, const TuneFamily& family,
                             Attempt attempt, const TuneGoal& goal);

/// Returns the page, one file. Each candidate is drawn, compared and, where the engine films, filmed.
Expected<std::string> tune_sheet(Engine& engine, const SheetInput& input);

}  // namespace gnomon::studies
