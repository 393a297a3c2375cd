// Consecutive ranges of numbers, and which of them a number lies in: the triangles of the world's instances.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace gnomon {

/// Ranges 0 … count-1 one after another, from 0 on; empty ones hold nothing.
class Ranges {
 public:
  Ranges() = default;
  /// Where each range begins, ascending from 0, and behind them where the last one ends.
  explicit Ranges(std::vector<std::uint32_t> begins) : begins_(std::move(begins)) {
    const std::size_t ranges = begins_.size() - 1;
    while ((std::uint64_t{size()} >> shift_) > 2 * ranges + 1) ++shift_;
    for (std::uint32_t at = 0, i = 0; at < size(); at += 1u << shift_) {
      while (begins_[i + 1] <= at) ++i;
      hints_.push_back(i);
      if (size() - at <= 1u << shift_) break;
    }
    if (ranges > 0) hints_.push_back(static_cast<std::uint32_t>(ranges) - 1);
  }

  /// One past the last number.
  std::uint32_t size() const { return begins_.empty() ? 0 : begins_.back(); }
  std::uint32_t begin_of(std::uint32_t range) const { return begins_[range]; }
  /// The range of a number below size().
  std::uint32_t of(std::uint32_t number) const {
    const std::uint32_t low = hints_[number >> shift_], high = hints_[(number >> shift_) + 1];
    if (low == high || number < begins_[low + 1]) return low;
    const auto at = std::upper_bound(begins_.begin() + low + 1, begins_.begin() + high + 1, number);
    return static_cast<std::uint32_t>(at - begins_.begin()) - 1;
  }

 private:
  std::vector<std::uint32_t> begins_, hints_;  ///< hints: of every 2^shift numbers the range of the first
  unsigned shift_ = 0;
};

}  // namespace gnomon
