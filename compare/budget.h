// Counting pixels and adding up steps. Every sum is taken row by row and then over the rows in order, so that
// it is the same for any number of threads; for a hard test all terms are integers and the sums are exact.
#pragma once

#include "compare/comparison.h"

namespace gnomon::compare {

/// The sums of a picture that comes in parts, each of whole rows, from the top: the same as those of the whole.
class PixelSums {
 public:
  void add(const std::array<Image<float>, rung_count>& rungs, const Image<Label>& labels);
  PixelCounts pixels() const;
  std::array<std::uint64_t, class_count> classes() const;
  ErrorStats error() const;
  std::array<double, rung_count> rung_means() const;
  RightByAccident accidents() const;
  std::array<BudgetStep, cause_count> budget() const;

 private:
  std::array<std::uint64_t, 256> labels_{};
  std::array<double, 7> error_{};
  std::array<double, rung_count + 1> rungs_{};
  std::array<double, 2> accidents_{};
  std::array<double, 4 * cause_count + 1> budget_{};
};

PixelCounts count_pixels(const Image<Label>& labels);
std::array<std::uint64_t, class_count> count_classes(const Image<Label>& labels);

/// wrong, false and missed shadow, ties, fractional, mean |V6 - V0| and RMS over compared pixels (FLIP and
/// SSIM are left NaN). Two pixels that are off by exactly one half count as one wrong pixel in the fraction.
ErrorStats measure_error(const std::array<Image<float>, rung_count>& rungs, const Image<Label>& labels);

/// Mean visibility of each rung over compared pixels; 0 where none is compared.
std::array<double, rung_count> mean_rungs(const std::array<Image<float>, rung_count>& rungs,
                                          const Image<Label>& labels);

/// For words: `sum`, or 0 where it is no more than what rounding leaves of it. `sizes`: what its terms add up to without
/// their signs.
double beyond_rounding(double sum, double sizes);

/// A pixel that the sampling step made wrong and that is drawn right.
bool is_accident(const std::array<float, rung_count>& rungs);
RightByAccident count_accidents(const std::array<Image<float>, rung_count>& rungs,
                                const Image<Label>& labels);

/// Means of the six steps over compared pixels, and the wrong pixels that each is to blame for.
std::array<BudgetStep, cause_count> add_up_budget(const std::array<Image<float>, rung_count>& rungs,
                                                  const Image<Label>& labels);

}  // namespace gnomon::compare
