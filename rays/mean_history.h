// The plain history: the mean of the last frames of a camera that stands still, as it grows to so many.
#pragma once

#include "rays/denoiser.h"

namespace gnomon::rays {

/// The k-th frame counts 1 / min(k, frames): a mean of all while there are no more, then a mean that forgets.
template <std::size_t count>
class MeanHistory {
 public:
  MeanHistory(int frames, ImageSize size) : most_(frames), size_(size) {}

  /// The mean with this frame in it, and the least penumbra that a ray of any of them told of.
  std::uint64_t add(const NoisyFrame<count>& frame) {
    held_ = std::min(held_ + 1, most_);
    if (held_ == 1) {
      mean_ = frame.signal;
      half_width_ = frame.rays.half_width;
      return 0;
    }
    const float share = 1.0f / static_cast<float>(held_);
    return filter_asked(frame.guides, mean_, [&](int x, int y, std::uint64_t& taps) {
      ++taps;
      const float now = frame.rays.half_width.at(x, y);
      float& kept = half_width_.at(x, y);
      if (now > 0.0f) kept = kept > 0.0f ? std::min(kept, now) : now;
      Signal<count> mean = between(mean_.at(x, y), frame.signal.at(x, y), share);
      if constexpr (count > alone) mean[blurred] = frame.signal.at(x, y)[blurred];
      return mean;
    });
  }

  const Image<Signal<count>>& mean() const { return mean_; }
  const Image<float>& half_width() const { return half_width_; }
  /// A history of one frame keeps nothing.
  std::uint64_t bytes() const { return most_ > 1 ? size_.pixels() * 2 * sizeof(float) : 0; }

 private:
  int most_, held_ = 0;
  ImageSize size_;
  Image<Signal<count>> mean_;
  Image<float> half_width_;
};

}  // namespace gnomon::rays
