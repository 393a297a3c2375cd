#include "compare/advice/rule.h"

#include <algorithm>
#include <cmath>

#include "compare/comparison.h"
#include "compare/result/figures.h"

namespace gnomon::compare {
namespace {

constexpr double clear_gain = 0.05;    // of what is there
constexpr double chance_spread = 2.0;  // standard deviations of a count

bool is_more_than_chance(double instead, double now, std::uint64_t compared) {
  const double wrong = now * static_cast<double>(compared);
  return wrong - instead * static_cast<double>(compared) > chance_spread * std::sqrt(wrong);
}

}  // namespace

Left left_by(const LightFigures& drawn, const Figure& measure) {
  return {drawn.error.wrong_fraction, drawn.error.mean_absolute, measure.of(drawn)};
}

bool is_worth_advising(const Left& instead, const Left& now, std::uint64_t compared) {
  if (instead.wrong_fraction > now.wrong_fraction || instead.mean_absolute > now.mean_absolute) return false;
  return instead.measured < (1.0 - clear_gain) * now.measured &&
         (is_more_than_chance(instead.wrong_fraction, now.wrong_fraction, compared) ||
          is_more_than_chance(instead.mean_absolute, now.mean_absolute, compared));
}

}  // namespace gnomon::compare
