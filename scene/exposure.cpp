// The percentile is a pixel's own value (nearest rank), so that it is the same for any number of threads and
// any order.
#include "scene/exposure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "scene/base/parallel.h"

namespace gnomon {

namespace {

/// Positive floats in the order of their bits; so many classes of them, by the highest of those.
constexpr int class_shift = 15;
constexpr std::size_t classes = std::size_t{1} << (31 - class_shift);
using Counts = std::vector<std::uint32_t>;

constexpr std::size_t block = 1 << 16;  // pixels per task

/// act(bits) for the luminance of each pixel that is positive and finite.
template <class Act>
void for_each_luminance(std::span<const Vec3f> linear, const Act& act) {
  const Vec3f weights(0.2126f, 0.7152f, 0.0722f);  // ITU-R BT.709-6, item 3.2
  for (const Vec3f& color : linear) {
    const float value = glm::dot(weights, color);
    if (std::isfinite(value) && value > 0.0f) act(std::bit_cast<std::uint32_t>(value));
  }
}

}  // namespace

AutoExposure::AutoExposure() : counts_(classes, 0) {}

void AutoExposure::count(std::span<const Vec3f> linear) {
  PerThread<Counts> shares([] { return Counts(classes, 0); });
  parallel_ranges(linear.size(), block, [&](std::size_t first, std::size_t last) {
    Counts& counts = shares.local();
    for_each_luminance(linear.subspan(first, last - first),
                       [&](std::uint32_t bits) { ++counts[bits >> class_shift]; });
  });
  for (const Counts& share : shares)
    for (std::size_t k = 0; k < classes; ++k) counts_[k] += share[k];
}

bool AutoExposure::choose() {
  const double count = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  if (count == 0.0) return false;
  rank_ = static_cast<std::uint64_t>(std::max(std::ceil(auto_exposure_percentile * count) - 1.0, 0.0));
  while (rank_ >= counts_[chosen_]) rank_ -= counts_[chosen_++];
  members_.reserve(counts_[chosen_]);
  return true;
}

void AutoExposure::collect(std::span<const Vec3f> linear) {
  for_each_luminance(linear, [&](std::uint32_t bits) {
    if (bits >> class_shift == chosen_) members_.push_back(bits);
  });
}

double AutoExposure::factor() {
  if (members_.empty()) return 1.0;
  const auto place = members_.begin() + static_cast<std::ptrdiff_t>(rank_);
  std::nth_element(members_.begin(), place, members_.end());
  return auto_exposure_target / static_cast<double>(std::bit_cast<float>(*place));
}

double auto_exposure(const ColorImage& linear) {
  AutoExposure exposure;
  exposure.count(linear.data);
  if (exposure.choose()) exposure.collect(linear.data);
  return exposure.factor();
}

}  // namespace gnomon
