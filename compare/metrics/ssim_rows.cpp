#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compare/metrics/ssim_rows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "compare/metrics/weighted_rows.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::compare::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using Half = hn::Rebind<float, D>;
using V = hn::Vec<D>;
constexpr D d;
constexpr Half half;

struct Inputs {
  std::span<const float*const> first, second;
  std::span<const double> weights;
};

/// Sums as many columns from x on as there are lanes.
void down_columns(const Inputs& in, int x, MomentRows& sums) {
  V m[5] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::size_t k = 0; k < in.weights.size(); ++k) {
    const V w = hn::Set(d, in.weights[k]);
    const V a = hn::PromoteTo(d, hn::LoadU(half, in.first[k] + x));
    const V b = hn::PromoteTo(d, hn::LoadU(half, in.second[k] + x));
    const V values[5] = {a, b, hn::Mul(a, a), hn::Mul(b, b), hn::Mul(a, b)};
    for (std::size_t j = 0; j < 5; ++j) m[j] = hn::Add(m[j], hn::Mul(w, values[j]));
  }
  for (std::size_t j = 0; j < 5; ++j) hn::StoreU(m[j], d, sums[j].data() + x);
}

/// What is read lies at x or behind it, so that it has not been written over.
void along_rows(std::span<const double> weights, int count, std::vector<double>& row) {
  const auto lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= count; x += lanes) {
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < weights.size(); ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, row.data() + x + k)));
    hn::StoreU(sum, d, row.data() + x);
  }
  for (; x < count; ++x) {
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * row[static_cast<std::size_t>(x) + k];
    row[static_cast<std::size_t>(x)] = sum;
  }
}

void window_moments_kernel(std::span<const float* const> first, std::span<const float* const> second,
                           std::span<const double> weights, int width, MomentRows& sums) {
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (auto& row : sums) row.resize(static_cast<std::size_t>(width));
  const Inputs in{first, second, weights};
  // The last columns once more where they do not fill a vector.
  for (int x = 0; x < width; x += lanes) down_columns(in, std::max(0, std::min(x, width - lanes)), sums);
  for (auto& row : sums) along_rows(weights, width - static_cast<int>(weights.size()) + 1, row);
}

}  // namespace
}  // namespace gnomon::compare::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::compare {
HWY_EXPORT(window_moments_kernel);

void window_moments(std::span<const float* const> first, std::span<const float* const> second,
                    std::span<const double> weights, int width, MomentRows& sums) {
  HWY_DYNAMIC_DISPATCH(window_moments_kernel)(first, second, weights, width, sums);
}

}  // namespace gnomon::compare
#endif  // HWY_ONCE
