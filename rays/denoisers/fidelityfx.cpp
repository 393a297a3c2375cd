// AMD's FidelityFX Shadow Denoiser (2021; its published source, version 1.0, is the definition), under a camera that stands still.
// It keeps moments of the history, clamps the history to the mean of 17 x 17 pixels and blends it with the frame. Three passes of
// 3 x 3 values follow, which lie 1, 2 and 4 pixels apart, and a contrast in the end. The first pass's output is what the history
// keeps. Two things are beside the source: shares of several rays may come in, and windows are weighed anew at the picture's edges
// and at pixels that are not asked. No block of 8 x 8 pixels is skipped for being all lit or all dark; it would stay so.
#include <array>
#include <utility>

#include "rays/denoiser.h"
#include "rays/places.h"

namespace gnomon::rays {
namespace {

constexpr int radius = 8;  // of the window of the mean
constexpr std::array kernel{1.0f, 2.0f / 3.0f, 1.0f / 6.0f};
constexpr float sigma_depth = 1.0f;  // world units, as its documentation has it
constexpr int passes = 3;

float window_weight(int i) {
  constexpr float side = radius + 1.0f;
  return std::exp(-3.0f * static_cast<float>(i * i) / (side * side));
}

template <std::size_t count>
class FidelityFx final : public Denoiser<count> {
 public:
  explicit FidelityFx(ImageSize size)
      : size_(size), rows_(size), means_(size), moments_(size), variance_(size), spare_variance_(size) {}

  std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) override {
    std::uint64_t taps = find_means(frame);
    taps += blend(frame);
    for (int pass = 0; pass < passes; ++pass) {
      taps += filter(frame.guides, 1 << pass, out);
      std::swap(variance_, spare_variance_);
      if (pass == 0) history_ = out;
      if (pass + 1 < passes) std::swap(in_, out);
    }
    parallel_for(out.data.size(), [&](std::size_t i) {
      // The contrast: light is darkened where the variance is small.
      float& end = out.data[i][drawn];
      end = std::pow(end, std::max(1.2f - variance_.data[i], 1.0f));
    });
    return taps;
  }
  std::unique_ptr<Denoiser<count>> clone() const override { return std::make_unique<FidelityFx>(*this); }
  std::uint64_t history_bytes() const override { return size_.pixels() * 4 * sizeof(float); }

 private:
  /// A mean of share, and the sum of its weights, along one axis.
  template <class Value>
  static Vec2f windowed(const Guides& guides, int x, int y, int dx, int dy, std::uint64_t& taps,
                        const Value& value) {
    Vec2f sum(0.0f);
    for (int i = -radius; i <= radius; ++i) {
      if (!lies_in(guides.size, x + i * dx, y + i * dy)) continue;
      ++taps;
      sum += window_weight(i) * value(x + i * dx, y + i * dy);
    }
    return sum;
  }

  std::uint64_t find_means(const NoisyFrame<count>& frame) {
    const Guides& guides = frame.guides;
    const auto along = [&](Image<Vec2f>& out, int dx, int dy, const auto& value) {
      return parallel_reduce(
          static_cast<std::size_t>(size_.height), 8, std::uint64_t{0},
          [&](std::size_t first, std::size_t last, std::uint64_t taps) {
            for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y)
              for (int x = 0; x < size_.width; ++x)
                out.at(x, y) = windowed(guides, x, y, dx, dy, taps, value);
            return taps;
          },
          [](std::uint64_t a, std::uint64_t b) { return a + b; });
    };
    const std::uint64_t taps = along(rows_, 1, 0, [&](int x, int y) {
      return guides.at(x, y).asked() ? Vec2f(frame.signal.at(x, y)[drawn], 1.0f) : Vec2f(0.0f);
    });
    return taps + along(means_, 0, 1, [&](int x, int y) { return rows_.at(x, y); });
  }

  /// Into in_ and variance_: moments, the clamp to the window's mean and the blend with the history.
  std::uint64_t blend(const NoisyFrame<count>& frame) {
    const std::uint64_t taps = filter_asked(frame.guides, in_, [&](int x, int y, std::uint64_t& read) {
      const Signal<count>& now = frame.signal.at(x, y);
      const bool goes_on = places_.stays(frame.guides, x, y);
      Vec3f& kept = moments_.at(x, y);  // mean, sum of squared deviations, frames
      if (!goes_on) kept = Vec3f(0.0f);
      const float frames = kept.z + 1.0f;
      const float mean_then = kept.x, mean_now = kept.x + (now[drawn] - kept.x) / frames;
      kept = Vec3f(mean_now, kept.y + (now[drawn] - mean_then) * (now[drawn] - mean_now), frames);
      float variance = frames > 1.0f ? kept.y / (frames - 1.0f) : 1.0f;
      const Vec2f& window = means_.at(x, y);
      const float mean = window.x / window.y, spread = std::max(mean - mean * mean, 0.0f);
      const float deviation = std::sqrt(spread);
      Signal<count> then = goes_on ? history_.at(x, y) : now;
      read += goes_on ? 1 : 0;
      // As in svgf: the passes blur this frame's truth alone.
      if constexpr (count > alone) then[blurred] = frame.moves ? now[blurred] : then[blurred];
      const float discontinuity = (then[drawn] - mean) / std::max(0.5f * deviation, 0.001f);
      kept.z *= std::exp(-discontinuity * discontinuity / 20.0f);
      if (kept.z < 16.0f) variance = std::max(variance, spread) * std::max(16.0f - kept.z, 1.0f);
      then[drawn] = std::clamp(then[drawn], mean - 0.5f * deviation, mean + 0.5f * deviation);
      const float young = std::sqrt(std::max(8.0f - kept.z, 0.0f) / 8.0f);
      variance_.at(x, y) = variance;
      return between(then, now, 0.05f + 0.95f * young);
    });
    places_.keep(frame.guides);
    return taps;
  }

  float blurred_variance(int x, int y, std::uint64_t& taps) const {
    constexpr std::array<std::array<float, 2>, 2> near{
        {{1.0f / 4.0f, 1.0f / 8.0f}, {1.0f / 8.0f, 1.0f / 16.0f}}};
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int qx = std::clamp(x + dx, 0, size_.width - 1), qy = std::clamp(y + dy, 0, size_.height - 1);
        ++taps;
        sum += near[std::size_t(std::abs(dx))][std::size_t(std::abs(dy))] * variance_.at(qx, qy);
      }
    return sum;
  }

  std::uint64_t filter(const Guides& guides, int step, Image<Signal<count>>& out) {
    return filter_asked(guides, out, [&](int x, int y, std::uint64_t& taps) {
      const Guide& here = guides.at(x, y);
      const Signal<count>& own = in_.at(x, y);
      const float deviation = std::sqrt(blurred_variance(x, y, taps) + 1e-9f);
      Signal<count> sum = own;
      float weights = 1.0f, variance = variance_.at(x, y);
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const int qx = x + i * step, qy = y + j * step;
          if ((i == 0 && j == 0) || !lies_in(size_, qx, qy) || !guides.at(qx, qy).asked()) continue;
          ++taps;
          const Guide& there = guides.at(qx, qy);
          const float alike = std::clamp(glm::dot(here.normal, there.normal), 0.0f, 1.0f);
          const float weight = kernel[std::size_t(std::abs(i))] * kernel[std::size_t(std::abs(j))] *
                               std::exp(-std::abs(own[drawn] - in_.at(qx, qy)[drawn]) / deviation -
                                        std::abs(here.depth - there.depth) / sigma_depth) *
                               std::pow(alike, 32.0f);
          add_weighted(weight, in_.at(qx, qy), sum);
          weights += weight, variance += weight * weight * variance_.at(qx, qy);
        }
      spare_variance_.at(x, y) = variance / (weights * weights);
      return scaled(sum, 1.0f / weights);
    });
  }

  ImageSize size_;
  Places places_;
  Image<Signal<count>> in_, history_;
  Image<Vec2f> rows_, means_;  // weighed sum and sum of weights
  Image<Vec3f> moments_;
  Image<float> variance_, spare_variance_;
};

}  // namespace

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_fidelityfx(ImageSize size) {
  return std::make_unique<FidelityFx<count>>(size);
}
template std::unique_ptr<Denoiser<alone>> make_fidelityfx<alone>(ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_fidelityfx<with_passengers>(ImageSize);

}  // namespace gnomon::rays
