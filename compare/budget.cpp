#include "compare/budget.h"

#include "compare/labelling.h"
#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

using Rungs = std::array<Image<float>, rung_count>;
using Labels = std::array<std::uint64_t, 256>;  ///< pixels by label

/// add(sums, pixel) for the compared pixels, all sums in one pass; `total` may hold those of the rows above.
template <std::size_t count, class Add>
void sum_compared(const Image<Label>& labels, const Add& add, std::array<double, count>& total) {
  using Sums = std::array<double, count>;
  std::vector<Sums> rows(static_cast<std::size_t>(labels.size.height), Sums{});
  const auto width = static_cast<std::size_t>(labels.size.width);
  parallel_for(rows.size(), [&](std::size_t y) {
    Sums sums{};
    for (std::size_t i = y * width; i < (y + 1) * width; ++i)
      if (is_compared(labels.data[i])) add(sums, i);
    rows[y] = sums;
  });
  for (const Sums& row : rows)
    for (std::size_t k = 0; k < count; ++k) total[k] += row[k];
}

/// How many pixels have each label.
Labels count_labels(const Image<Label>& labels) {
  constexpr std::size_t block = 1 << 16;
  return parallel_reduce(
      labels.data.size(), block, Labels{},
      [&](std::size_t first, std::size_t last, Labels counts) {
        for (std::size_t i = first; i < last; ++i) ++counts[static_cast<std::uint8_t>(labels.data[i])];
        return counts;
      },
      [](Labels a, const Labels& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
        return a;
      });
}

PixelCounts pixels_of(const Labels& labels) {
  const auto of = [&labels](Label label) { return labels[static_cast<std::uint8_t>(label)]; };
  PixelCounts counts;
  for (const std::uint64_t count : labels) counts.total += count;
  counts.background = of(Label::background);
  counts.facing_away = of(Label::facing_away);
  counts.silhouette = of(Label::silhouette);
  counts.uncertain = of(Label::uncertain);
  counts.compared =
      counts.total - counts.background - counts.facing_away - counts.silhouette - counts.uncertain;
  return counts;
}

std::array<std::uint64_t, class_count> classes_of(const Labels& labels) {
  std::array<std::uint64_t, class_count> classes{};
  for (std::size_t k = 0; k < class_count; ++k) classes[k] = labels[k + 1];  // Label's first values
  return classes;
}

using ErrorSums = std::array<double, 7>;

void sum_errors(const Rungs& rungs, const Image<Label>& labels, ErrorSums& total) {
  const auto between = [](float v) { return v > 0.0f && v < 1.0f; };
  sum_compared(
      labels,
      [&](auto& sums, std::size_t i) {
        const float drawn = rungs[6].data[i], truth = rungs[0].data[i];
        const double difference = double(drawn) - double(truth);
        sums[0] += 1.0;
        sums[1] += difference < -0.5 ? 1.0 : 0.0, sums[2] += difference > 0.5 ? 1.0 : 0.0;
        sums[3] += std::abs(difference) == 0.5 ? 1.0 : 0.0;
        sums[4] += between(drawn) || between(truth) ? 1.0 : 0.0;
        sums[5] += std::abs(difference), sums[6] += difference * difference;
      },
      total);
}

ErrorStats error_of(const ErrorSums& sums) {
  const auto [count, false_shadow, missed_shadow, ties, fractional, absolute, squared] = sums;
  ErrorStats error;
  error.false_shadow = static_cast<std::uint64_t>(false_shadow);
  error.missed_shadow = static_cast<std::uint64_t>(missed_shadow);
  error.wrong = error.false_shadow + error.missed_shadow;
  error.ties = static_cast<std::uint64_t>(ties);
  error.fractional = static_cast<std::uint64_t>(fractional);
  if (!(count > 0.0)) return error;
  error.wrong_fraction = (double(error.wrong) + 0.5 * double(error.ties)) / count;
  error.mean_absolute = absolute / count;
  error.rms = std::sqrt(squared / count);
  return error;
}

std::array<float, rung_count> rungs_of(const Rungs& rungs, std::size_t pixel) {
  std::array<float, rung_count> v{};
  for (std::size_t k = 0; k < rung_count; ++k) v[k] = rungs[k].data[pixel];
  return v;
}

void sum_rungs(const Rungs& rungs, const Image<Label>& labels, std::array<double, rung_count + 1>& total) {
  sum_compared(
      labels,
      [&](auto& sum, std::size_t i) {
        for (std::size_t k = 0; k < rung_count; ++k) sum[k] += double(rungs[k].data[i]);
        sum[rung_count] += 1.0;
      },
      total);
}

std::array<double, rung_count> means_of(const std::array<double, rung_count + 1>& sums) {
  std::array<double, rung_count> means{};
  const double count = sums[rung_count];
  for (std::size_t k = 0; k < rung_count && count > 0.0; ++k) means[k] = sums[k] / count;
  return means;
}

void sum_accidents(const Rungs& rungs, const Image<Label>& labels, std::array<double, 2>& total) {
  sum_compared(
      labels,
      [&](auto& sums, std::size_t i) {
        const std::array<float, rung_count> v = rungs_of(rungs, i);
        if (is_accident(v)) sums[v[2] > v[0] ? 0 : 1] += 1.0;
      },
      total);
}

RightByAccident accidents_of(const std::array<double, 2>& sums) {
  return {static_cast<std::uint64_t>(sums[0]), static_cast<std::uint64_t>(sums[1])};
}

using BudgetSums = std::array<double, 4 * cause_count + 1>;

void sum_budget(const Rungs& rungs, const Image<Label>& labels, BudgetSums& total) {
  sum_compared(
      labels,
      [&](auto& sum, std::size_t i) {
        const std::array<float, rung_count> v = rungs_of(rungs, i);
        for (std::size_t k = 0; k < cause_count; ++k) {
          const double step = double(v[k + 1]) - double(v[k]);
          sum[4 * k] += step, sum[4 * k + 1] += std::abs(step);
        }
        if (is_wrong(labels.data[i])) {
          const auto step = static_cast<std::size_t>(step_of_label(labels.data[i], v));
          sum[4 * step + (v[6] < v[0] ? 2 : 3)] += 1.0;
        }
        sum[4 * cause_count] += 1.0;
      },
      total);
}

std::array<BudgetStep, cause_count> budget_of(const BudgetSums& sums) {
  std::array<BudgetStep, cause_count> budget{};
  const double count = sums[4 * cause_count];
  for (std::size_t k = 0; k < cause_count && count > 0.0; ++k)
    budget[k] = {sums[4 * k] / count, sums[4 * k + 1] / count, static_cast<std::uint64_t>(sums[4 * k + 2]),
                 static_cast<std::uint64_t>(sums[4 * k + 3])};
  return budget;
}

}  // namespace

// Sums are taken along rows of pixels and then over the rows, 16384 of each at most, and each addition is off by 2^-53
// of `sizes` at most: together by 2^-38. Means and the six steps add few roundings more, for which this is twice that.
// A hard test's sum is a whole number of pixels, of 2^28 at most, and never so small unless it is 0.
double beyond_rounding(double sum, double sizes) {
  constexpr double most = 0x1p-37;
  return std::abs(sum) > most * sizes ? sum : 0.0;
}

bool is_accident(const std::array<float, rung_count>& v) {
  return std::abs(v[2] - v[0]) > 0.5f && !(std::abs(v[1] - v[0]) > 0.5f) && !(std::abs(v[6] - v[0]) > 0.5f);
}

void PixelSums::add(const Rungs& rungs, const Image<Label>& labels) {
  const Labels counted = count_labels(labels);
  for (std::size_t k = 0; k < counted.size(); ++k) labels_[k] += counted[k];
  sum_errors(rungs, labels, error_);
  sum_rungs(rungs, labels, rungs_);
  sum_accidents(rungs, labels, accidents_);
  sum_budget(rungs, labels, budget_);
}

PixelCounts PixelSums::pixels() const {
  return pixels_of(labels_);
}
std::array<std::uint64_t, class_count> PixelSums::classes() const {
  return classes_of(labels_);
}
ErrorStats PixelSums::error() const {
  return error_of(error_);
}
std::array<double, rung_count> PixelSums::rung_means() const {
  return means_of(rungs_);
}
RightByAccident PixelSums::accidents() const {
  return accidents_of(accidents_);
}
std::array<BudgetStep, cause_count> PixelSums::budget() const {
  return budget_of(budget_);
}

PixelCounts count_pixels(const Image<Label>& labels) {
  return pixels_of(count_labels(labels));
}

std::array<std::uint64_t, class_count> count_classes(const Image<Label>& labels) {
  return classes_of(count_labels(labels));
}

ErrorStats measure_error(const Rungs& rungs, const Image<Label>& labels) {
  ErrorSums sums{};
  sum_errors(rungs, labels, sums);
  return error_of(sums);
}

std::array<double, rung_count> mean_rungs(const Rungs& rungs, const Image<Label>& labels) {
  std::array<double, rung_count + 1> sums{};
  sum_rungs(rungs, labels, sums);
  return means_of(sums);
}

RightByAccident count_accidents(const Rungs& rungs, const Image<Label>& labels) {
  std::array<double, 2> sums{};
  sum_accidents(rungs, labels, sums);
  return accidents_of(sums);
}

std::array<BudgetStep, cause_count> add_up_budget(const Rungs& rungs, const Image<Label>& labels) {
  BudgetSums sums{};
  sum_budget(rungs, labels, sums);
  return budget_of(sums);
}

}  // namespace gnomon::compare
