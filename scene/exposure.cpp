// The percentile is a pixel's own value (nearest rank), so that it is the same for any number of threads and
// any order.
#include "scene/exposure.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gnomon {

namespace {

/// Positive floats in the order of their bits; so many classes of them, by the highest of those.
constexpr int class_shift = 15;
constexpr std::size_t classes = std::size_t{1} << (31 - class_shift);
using Counts = std::vector<std::uint32_t>;

constexpr std::size_t block = 1 << 16;  // pixels per task

/// act(bits) for the luminance of each pixel of a range that is positive and finite.
template <class Range, class Act>
void for_each_luminance(const ColorImage& linear, const Range& range, const Act& act) {
  const Vec3f weights(0.2126f, 0.7152f, 0.0722f);  // ITU-R BT.709-6, item 3.2
  for (std::size_t i = range.begin(); i != range.end(); ++i) {
    const float value = glm::dot(weights, linear.data[i]);
    if (std::isfinite(value) && value > 0.0f) act(std::bit_cast<std::uint32_t>(value));
  }
}

Counts count_classes(const ColorImage& linear) {
  tbb::enumerable_thread_specific<Counts> shares(Counts(classes, 0));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, linear.data.size(), block), [&](const auto& range) {
    Counts& counts = shares.local();
    for_each_luminance(linear, range, [&](std::uint32_t bits) { ++counts[bits >> class_shift]; });
  });
  Counts counts(classes, 0);
  for (const Counts& share : shares)
    for (std::size_t k = 0; k < classes; ++k) counts[k] += share[k];
  return counts;
}

}  // namespace

double auto_exposure(const ColorImage& linear) {
  const Counts counts = count_classes(linear);
  const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (count == 0.0) return 1.0;
  auto rank = static_cast<std::uint64_t>(std::max(std::ceil(auto_exposure_percentile * count) - 1.0, 0.0));
  std::uint32_t chosen = 0;
  while (rank >= counts[chosen]) rank -= counts[chosen++];

  std::vector<std::uint32_t> members;  // of its class
  members.reserve(counts[chosen]);
  for_each_luminance(linear, tbb::blocked_range<std::size_t>(0, linear.data.size()), [&](std::uint32_t bits) {
    if (bits >> class_shift == chosen) members.push_back(bits);
  });
  const auto place = members.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(members.begin(), place, members.end());
  return auto_exposure_target / static_cast<double>(std::bit_cast<float>(*place));
}

}  // namespace gnomon
