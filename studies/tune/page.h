// What the page of the tuner says before the comparison at the answer. It says the answer and what it was measured to
// give, what accuracy costs, and the runners-up with the reasons. It also says how the error of each kind of bias
// depends on the bias.
#pragma once

#include <string>
#include <vector>

#include "report/page.h"
#include "studies/tune/tune.h"

namespace gnomon::studies {

struct TunePageInput {
  std::string scene;
  const TuneGoal& goal;
  const TuneResult& result;
  const std::vector<std::string>& commands;  ///< of compare, by family
  std::vector<std::size_t> order;            ///< the families but the winner, best first
};

report::PageIntroduction tune_introduction(const TunePageInput& input);

}  // namespace gnomon::studies
