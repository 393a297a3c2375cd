// The page of the tuner: the answer and what it was measured to give, what accuracy costs, the runners-up
// with the reasons, how the error of each kind of bias hangs on the bias; then the comparison at the answer,
// with everything that the page of a comparison has.
#pragma once

#include <string>
#include <vector>

#include "report/page.h"
#include "studies/tune/tune.h"

namespace gnomon::compare {

struct TunePageInput {
  std::string scene;
  const TuneGoal& goal;
  const TuneResult& result;
  const std::vector<std::string>& commands;  ///< of compare, by family
  std::vector<std::size_t> order;            ///< the families but the winner, best first
};

PageIntroduction tune_introduction(const TunePageInput& input);

/// The error that the goal is about against milliseconds, both on logarithmic scales: every map tried, and
/// the goal. Empty where nothing was timed.
std::string tune_cost_chart(const TuneGoal& goal, const TuneResult& result);

/// Wrong pixels against the constant bias, in texels, of every family whose gaps tell it.
std::string tune_chart(const TuneResult& result);

}  // namespace gnomon::compare
