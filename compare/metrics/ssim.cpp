// The window separates, so each of the five local means is taken along columns and then along rows; rows run
// in parallel, so that the result does not depend on the number of threads. Where both pictures of a window are equal nothing
// is to be computed: the similarity is 1.
#include "compare/metrics/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compare/metrics/differing.h"
#include "compare/metrics/weighted_rows.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

constexpr double sigma = 1.5;                         // pixels
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // (K1 L)^2 and (K2 L)^2 with L = 1
std::array<double, ssim_window> gaussian() {
  std::array<double, ssim_window> weights{};
  constexpr std::size_t middle = ssim_window / 2;
  double sum = 0.0;
  for (std::size_t i = 0; i < ssim_window; ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(middle);
    weights[i] = std::exp(-x * x / (2.0 * sigma * sigma));
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

// Weighted means over a window: of x, y, x^2, y^2 and xy.
using Moments = std::array<double, 5>;

// Equation 13 of the paper.
double similarity(const Moments& m) {
  const double mean_product = m[0] * m[1], squares = m[0] * m[0] + m[1] * m[1];
  const double variances = m[2] + m[3] - squares, covariance = m[4] - mean_product;
  return (2.0 * mean_product + c1) * (2.0 * covariance + c2) / ((squares + c1) * (variances + c2));
}

}  // namespace

Image<float> ssim_map(const Image<float>& reference, const Image<float>& test) {
  const ImageSize size = reference.size;
  if (size.width < ssim_window || size.height < ssim_window) return {};
  const auto weights = gaussian();
  const ImageSize out_size{size.width - ssim_window + 1, size.height - ssim_window + 1};
  Image<float> map(out_size, 1.0f);  // of equal windows, to the last bit
  const Differing differing(
      size, [&](std::size_t i) { return reference.data[i]; }, [&](std::size_t i) { return test.data[i]; });
  parallel_for(out_size.height, [&](int y) {
    thread_local MomentRows sums;
    differing.for_each_range(y, y + ssim_window, 0, ssim_window - 1, [&](const ColumnRange& range) {
      const int count = std::min(range.end, out_size.width) - range.first;
      if (count <= 0) return;
      std::array<const float*, ssim_window> first{}, second{};
      for (std::size_t k = 0; k < ssim_window; ++k) {
        const std::size_t row = reference.index(range.first, y + static_cast<int>(k));
        first[k] = &reference.data[row], second[k] = &test.data[row];
      }
      window_moments(first, second, weights, count + ssim_window - 1, sums);
      for (int x = 0; x < count; ++x) {
        const auto i = static_cast<std::size_t>(x);
        map.at(range.first + x, y) =
            static_cast<float>(similarity({sums[0][i], sums[1][i], sums[2][i], sums[3][i], sums[4][i]}));
      }
    });
  });
  return map;
}

double mean_ssim(const Image<float>& reference, const Image<float>& test) {
  return mean_ssim(ssim_map(reference, test));
}

Image<float> ssim_by_pixel(const Image<float>& map, ImageSize size) {
  Image<float> out(size, std::numeric_limits<float>::quiet_NaN());
  constexpr int middle = ssim_window / 2;
  for (int y = 0; y < map.size.height; ++y)
    for (int x = 0; x < map.size.width; ++x) out.at(x + middle, y + middle) = map.at(x, y);
  return out;
}

double mean_ssim(const Image<float>& map) {
  if (map.data.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const float value : map.data) sum += static_cast<double>(value);
  return sum / static_cast<double>(map.data.size());
}

}  // namespace gnomon::compare
