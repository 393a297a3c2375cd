#include "studies/tune/tuner.h"

#include "scene/base/time_difference.h"

namespace gnomon::studies {
namespace {

bool costs_less(const Attempt& a, const Attempt& b) {
  const bool no_more = a.map_texels <= b.map_texels && a.map_bytes <= b.map_bytes && a.rays <= b.rays;
  return no_more && (a.map_texels < b.map_texels || a.map_bytes < b.map_bytes || a.rays < b.rays);
}

}  // namespace

Ties ties_with(std::size_t best, const std::vector<FamilyResult>& families, const TuneGoal& goal) {
  const Attempt& first = *families[best].answer;
  Ties ties{best, {}};
  std::vector<std::size_t> close;
  for (std::size_t i = 0; i < families.size(); ++i) {
    const std::optional<Attempt>& other = families[i].answer;
    if (i == best || !other || other->times.runs.empty()) continue;
    if (clearly_faster(first.times, other->times, true)) continue;
    if (goal.max_time_ms && other->error != first.error) continue;
    close.push_back(i);
    if (costs_less(*other, *families[ties.chosen].answer)) ties.chosen = i;
  }
  close.push_back(best);
  for (const std::size_t i : close)
    if (i != ties.chosen) ties.others.push_back(i);
  return ties;
}

std::vector<JustOver> just_over_limit(std::size_t winner, const std::vector<FamilyResult>& families,
                                      const TuneGoal& goal) {
  if (!goal.max_time_ms || !families[winner].answer) return {};
  const double limit = *goal.max_time_ms, to_beat = families[winner].answer->error;
  std::vector<JustOver> over;
  for (std::size_t i = 0; i < families.size(); ++i) {
    const Attempt* best = nullptr;
    for (const Attempt& a : families[i].tried)
      if (a.cost > limit && a.cost <= (1.0 + single_run_share) * limit && a.error < to_beat &&
          (best == nullptr || a.error < best->error))
        best = &a;
    if (best != nullptr) over.push_back({i, *best});
  }
  return over;
}

}  // namespace gnomon::studies
