// The plain history: at each pixel the mean of the last frames, as it grows to so many.
#pragma once

#include "rays/denoiser.h"
#include "rays/places.h"

namespace gnomon::rays {

/// The k-th frame of a place counts 1 / min(k, frames): a mean of all while there are no more, then a mean that forgets.
template <std::size_t count>
class MeanHistory {
 public:
  MeanHistory(int frames, ImageSize size)
      : most_(static_cast<float>(frames)), mean_(size, all_of<count>(1.0f)), half_width_(size), held_(size) {}

  /// Takes the frame in: its shares, and the mean width of the penumbrae that its rays tell of.
  std::uint64_t add(const NoisyFrame<count>& frame) {
    const std::uint64_t taps = filter_asked(frame.guides, mean_, [&](int x, int y, std::uint64_t& read) {
      const bool goes_on = places_.stays(frame.guides, x, y);
      float& held = held_.at(x, y);
      held = goes_on ? std::min(held + 1.0f, most_) : 1.0f;
      float& width = half_width_.at(x, y);
      const float now = frame.rays.half_width.at(x, y);
      if (!goes_on || !(width > 0.0f))
        width = now;
      else if (now > 0.0f)
        width += (now - width) / held;
      const Signal<count>& signal = frame.signal.at(x, y);
      if (held == 1.0f) return signal;
      ++read;
      Signal<count> mean = between(mean_.at(x, y), signal, 1.0f / held);
      if constexpr (count > alone) mean[blurred] = signal[blurred];
      return mean;
    });
    if (most_ > 1.0f) places_.keep(frame.guides);
    return taps;
  }

  const Image<Signal<count>>& mean() const { return mean_; }
  const Image<float>& half_width() const { return half_width_; }
  /// A history of one frame keeps nothing; else the share, the width and how many frames it holds.
  std::uint64_t bytes() const { return most_ > 1.0f ? mean_.size.pixels() * 3 * sizeof(float) : 0; }

 private:
  float most_;
  Image<Signal<count>> mean_;
  Image<float> half_width_, held_;
  Places places_;
};

}  // namespace gnomon::rays
