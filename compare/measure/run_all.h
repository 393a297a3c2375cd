// Steps that do not depend on each other, over all threads.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "scene/base/expected.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {

using Step = std::function<Expected<void>()>;

/// Runs the steps and returns the error of the first one that failed; after a failure none is begun that was not to run at
/// the same time. `together`: how many run at a time at most.
inline Expected<void> run_all(const std::vector<Step>& steps, std::size_t together = 64) {
  for (std::size_t first = 0; first < steps.size(); first += together) {
    std::vector<Expected<void>> results(std::min(together, steps.size() - first));
    parallel_for(results.size(), [&](std::size_t i) { results[i] = steps[first + i](); });
    for (const Expected<void>& result : results)
      if (!result) return result;
  }
  return {};
}

/// How many steps to run at a time that take so many bytes each.
inline std::size_t steps_together(double bytes) {
  constexpr double most_bytes = 1e9;
  return static_cast<std::size_t>(std::max(1.0, std::min(64.0, most_bytes / bytes)));
}

}  // namespace gnomon::compare
