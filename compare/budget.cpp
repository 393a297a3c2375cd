#include "compare/budget.h"

#include <tbb/parallel_for.h>

namespace gnomon::compare {
namespace {

// Sums term(pixel) over the compared pixels.
template <class Term>
double sum_compared(const Image<Label>& labels, const Term& term) {
  std::vector<double> rows(static_cast<std::size_t>(labels.size.height), 0.0);
  const auto width = static_cast<std::size_t>(labels.size.width);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    double sum = 0.0;
    for (std::size_t i = y * width; i < (y + 1) * width; ++i)
      if (is_compared(labels.data[i])) sum += term(i);
    rows[y] = sum;
  });
  double total = 0.0;
  for (const double row : rows) total += row;
  return total;
}

}  // namespace

PixelCounts count_pixels(const Image<Label>& labels) {
  PixelCounts counts;
  counts.total = labels.data.size();
  for (const Label label : labels.data) {
    switch (label) {
      case Label::background:
        ++counts.background;
        break;
      case Label::facing_away:
        ++counts.facing_away;
        break;
      case Label::silhouette:
        ++counts.silhouette;
        break;
      case Label::uncertain:
        ++counts.uncertain;
        break;
      default:
        ++counts.compared;
        break;
    }
  }
  return counts;
}

std::array<std::uint64_t, class_count> count_classes(const Image<Label>& labels) {
  std::array<std::uint64_t, class_count> classes{};
  for (const Label label : labels.data)
    if (is_wrong(label)) ++classes[static_cast<std::size_t>(label) - 1];
  return classes;
}

ErrorStats measure_error(const std::array<Image<float>, rung_count>& rungs, const Image<Label>& labels) {
  const auto difference = [&](std::size_t i) { return double(rungs[6].data[i]) - double(rungs[0].data[i]); };
  ErrorStats error;
  error.false_shadow =
      static_cast<std::uint64_t>(sum_compared(labels, [&](auto i) { return difference(i) < -0.5; }));
  error.missed_shadow =
      static_cast<std::uint64_t>(sum_compared(labels, [&](auto i) { return difference(i) > 0.5; }));
  error.wrong = error.false_shadow + error.missed_shadow;
  const double count = sum_compared(labels, [](auto) { return 1.0; });
  if (!(count > 0.0)) return error;
  error.wrong_fraction = double(error.wrong) / count;
  error.mean_absolute = sum_compared(labels, [&](auto i) { return std::abs(difference(i)); }) / count;
  error.rms = std::sqrt(sum_compared(labels, [&](auto i) { return difference(i) * difference(i); }) / count);
  return error;
}

std::array<double, rung_count> mean_rungs(const std::array<Image<float>, rung_count>& rungs,
                                          const Image<Label>& labels) {
  std::array<double, rung_count> means{};
  const double count = sum_compared(labels, [](auto) { return 1.0; });
  if (!(count > 0.0)) return means;
  for (std::size_t k = 0; k < rung_count; ++k)
    means[k] = sum_compared(labels, [&](auto i) { return double(rungs[k].data[i]); }) / count;
  return means;
}

std::array<BudgetStep, cause_count> add_up_budget(const std::array<Image<float>, rung_count>& rungs,
                                                  const Image<Label>& labels) {
  std::array<BudgetStep, cause_count> budget{};
  const double count = sum_compared(labels, [](auto) { return 1.0; });
  if (!(count > 0.0)) return budget;
  for (std::size_t k = 0; k < cause_count; ++k) {
    const auto step = [&](std::size_t i) { return double(rungs[k + 1].data[i]) - double(rungs[k].data[i]); };
    budget[k].signed_mean = sum_compared(labels, step) / count;
    budget[k].absolute_mean = sum_compared(labels, [&](auto i) { return std::abs(step(i)); }) / count;
  }
  return budget;
}

}  // namespace gnomon::compare
