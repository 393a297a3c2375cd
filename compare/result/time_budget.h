// The time budget of a run in the words of the outputs: every stage with its wall-clock and its processor
// time, summing to the process.
#pragma once

#include <string>

#include "scene/base/stages.h"

namespace gnomon::compare {

/// `document` (a JSON object, indented by 2) with the keys "process" and "time_budget" added at its end.
std::string with_time_budget(std::string document, const TimeBudget& budget);
/// The same with the time of this thread's StageLog up to now; unchanged where there is none.
std::string with_time_budget(std::string document);

/// For the terminal, at most 80 columns wide: the whole and what takes most of it.
std::string time_budget_text(const TimeBudget& budget, bool colour);

}  // namespace gnomon::compare
