#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compare/metrics/weighted_rows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "compare/metrics/weighted_rows.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::compare::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::ScalableTag<float>;
constexpr F f;

/// Four vectors' sums stay in registers while the rows go by.
void add_weighted_rows_kernel(std::span<const float* const> rows, std::span<const float> weights, float* sums,
                              int width) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(f));
  const auto weighted = [&](std::size_t k, std::ptrdiff_t x) {
    return hn::Mul(hn::Set(f, weights[k]), hn::LoadU(f, rows[k] + x));
  };
  std::ptrdiff_t x = 0;
  for (; x + 4 * lanes <= width; x += 4 * lanes) {
    auto a = hn::LoadU(f, sums + x), b = hn::LoadU(f, sums + x + lanes);
    auto c = hn::LoadU(f, sums + x + 2 * lanes), d = hn::LoadU(f, sums + x + 3 * lanes);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      a = hn::Add(a, weighted(k, x)), b = hn::Add(b, weighted(k, x + lanes));
      c = hn::Add(c, weighted(k, x + 2 * lanes)), d = hn::Add(d, weighted(k, x + 3 * lanes));
    }
    hn::StoreU(a, f, sums + x), hn::StoreU(b, f, sums + x + lanes);
    hn::StoreU(c, f, sums + x + 2 * lanes), hn::StoreU(d, f, sums + x + 3 * lanes);
  }
  for (; x < width; ++x)
    for (std::size_t k = 0; k < rows.size(); ++k) sums[x] += weights[k] * rows[k][x];
}

}  // namespace
}  // namespace gnomon::compare::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::compare {
HWY_EXPORT(add_weighted_rows_kernel);

void add_weighted_rows(std::span<const float* const> rows, std::span<const float> weights, float* sums,
                       int width) {
  HWY_DYNAMIC_DISPATCH(add_weighted_rows_kernel)(rows, weights, sums, width);
}

}  // namespace gnomon::compare
#endif  // HWY_ONCE
