#include "compare/measure/pixel_measures.h"

#include "compare/result/shadow_cost.h"

namespace gnomon::compare {

void OutsideSum::add(const LadderInput& in, const Climb& climb) {
  const Image<std::uint8_t>& outside = in.record().outside_map;  // empty where the drawing has none
  for (std::size_t i = 0; i < outside.data.size(); ++i) {
    if (outside.data[i] == 0 || !is_compared(climb.labels.data[i])) continue;
    ++sum_.receivers;
    if (climb.rungs.front().data[i] < 0.5f) ++sum_.shadowed;
    if (climb.rungs.back().data[i] < 0.5f) ++sum_.drawn_dark;
  }
}

void LookupSum::add(const LadderInput& in, const Climb& climb) {
  if (const auto lookups = count_lookups(in.drawn, in.record(), climb.labels))
    sum_ = sum_.value_or(0) + *lookups;
}

}  // namespace gnomon::compare
