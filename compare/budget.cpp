#include "compare/budget.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "compare/labelling.h"

namespace gnomon::compare {
namespace {

/// add(sums, pixel) for the compared pixels, all sums in one pass.
template <std::size_t count, class Add>
std::array<double, count> sum_compared(const Image<Label>& labels, const Add& add) {
  using Sums = std::array<double, count>;
  std::vector<Sums> rows(static_cast<std::size_t>(labels.size.height), Sums{});
  const auto width = static_cast<std::size_t>(labels.size.width);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    Sums sums{};
    for (std::size_t i = y * width; i < (y + 1) * width; ++i)
      if (is_compared(labels.data[i])) add(sums, i);
    rows[y] = sums;
  });
  Sums total{};
  for (const Sums& row : rows)
    for (std::size_t k = 0; k < count; ++k) total[k] += row[k];
  return total;
}

/// How many pixels have each label.
std::array<std::uint64_t, 256> count_labels(const Image<Label>& labels) {
  using Counts = std::array<std::uint64_t, 256>;
  constexpr std::size_t block = 1 << 16;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, labels.data.size(), block), Counts{},
      [&](const auto& range, Counts counts) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          ++counts[static_cast<std::uint8_t>(labels.data[i])];
        return counts;
      },
      [](Counts a, const Counts& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
        return a;
      });
}

}  // namespace

PixelCounts count_pixels(const Image<Label>& labels) {
  const auto of = [counts = count_labels(labels)](Label label) {
    return counts[static_cast<std::uint8_t>(label)];
  };
  PixelCounts counts;
  counts.total = labels.data.size();
  counts.background = of(Label::background);
  counts.facing_away = of(Label::facing_away);
  counts.silhouette = of(Label::silhouette);
  counts.uncertain = of(Label::uncertain);
  counts.compared =
      counts.total - counts.background - counts.facing_away - counts.silhouette - counts.uncertain;
  return counts;
}

std::array<std::uint64_t, class_count> count_classes(const Image<Label>& labels) {
  const auto counts = count_labels(labels);
  std::array<std::uint64_t, class_count> classes{};
  for (std::size_t k = 0; k < class_count; ++k) classes[k] = counts[k + 1];  // Label's first values
  return classes;
}

ErrorStats measure_error(const std::array<Image<float>, rung_count>& rungs, const Image<Label>& labels) {
  const auto between = [](float v) { return v > 0.0f && v < 1.0f; };
  const auto [count, false_shadow, missed_shadow, ties, fractional, absolute, squared] =
      sum_compared<7>(labels, [&](auto& sums, std::size_t i) {
        const float drawn = rungs[6].data[i], truth = rungs[0].data[i];
        const double difference = double(drawn) - double(truth);
        sums[0] += 1.0;
        sums[1] += difference < -0.5 ? 1.0 : 0.0, sums[2] += difference > 0.5 ? 1.0 : 0.0;
        sums[3] += std::abs(difference) == 0.5 ? 1.0 : 0.0;
        sums[4] += between(drawn) || between(truth) ? 1.0 : 0.0;
        sums[5] += std::abs(difference), sums[6] += difference * difference;
      });
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

std::array<double, rung_count> mean_rungs(const std::array<Image<float>, rung_count>& rungs,
                                          const Image<Label>& labels) {
  const auto sums = sum_compared<rung_count + 1>(labels, [&](auto& sum, std::size_t i) {
    for (std::size_t k = 0; k < rung_count; ++k) sum[k] += double(rungs[k].data[i]);
    sum[rung_count] += 1.0;
  });
  std::array<double, rung_count> means{};
  const double count = sums[rung_count];
  for (std::size_t k = 0; k < rung_count && count > 0.0; ++k) means[k] = sums[k] / count;
  return means;
}

namespace {

std::array<float, rung_count> rungs_of(const std::array<Image<float>, rung_count>& rungs, std::size_t pixel) {
  std::array<float, rung_count> v{};
  for (std::size_t k = 0; k < rung_count; ++k) v[k] = rungs[k].data[pixel];
  return v;
}

}  // namespace

bool is_accident(const std::array<float, rung_count>& v) {
  return std::abs(v[2] - v[0]) > 0.5f && !(std::abs(v[1] - v[0]) > 0.5f) && !(std::abs(v[6] - v[0]) > 0.5f);
}

RightByAccident count_accidents(const std::array<Image<float>, rung_count>& rungs,
                                const Image<Label>& labels) {
  const auto [shadowed, lit] = sum_compared<2>(labels, [&](auto& sums, std::size_t i) {
    const std::array<float, rung_count> v = rungs_of(rungs, i);
    if (is_accident(v)) sums[v[2] > v[0] ? 0 : 1] += 1.0;
  });
  return {static_cast<std::uint64_t>(shadowed), static_cast<std::uint64_t>(lit)};
}

std::array<BudgetStep, cause_count> add_up_budget(const std::array<Image<float>, rung_count>& rungs,
                                                  const Image<Label>& labels) {
  const auto sums = sum_compared<4 * cause_count + 1>(labels, [&](auto& sum, std::size_t i) {
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
  });
  std::array<BudgetStep, cause_count> budget{};
  const double count = sums[4 * cause_count];
  for (std::size_t k = 0; k < cause_count && count > 0.0; ++k)
    budget[k] = {sums[4 * k] / count, sums[4 * k + 1] / count, static_cast<std::uint64_t>(sums[4 * k + 2]),
                 static_cast<std::uint64_t>(sums[4 * k + 3])};
  return budget;
}

}  // namespace gnomon::compare
