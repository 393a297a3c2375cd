// Spatiotemporal variance-guided filtering: Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering: Real-Time
// Reconstruction for Path-Traced Global Illumination", sections 4.1 to 4.4. Visibility stands in the place of luminance, and the
// camera stands still. Five passes of the à-trous wavelet have a tolerance of visibility that follows the variance. The first
// pass's output is what the history keeps.
#include <array>
#include <utility>

#include "rays/denoiser.h"
#include "rays/places.h"

namespace gnomon::rays {
namespace {

constexpr std::array kernel{1.0f / 16.0f, 1.0f / 4.0f, 3.0f / 8.0f, 1.0f / 4.0f, 1.0f / 16.0f};
constexpr std::array near_kernel{1.0f / 4.0f, 1.0f / 2.0f,
                                 1.0f / 4.0f};  // the 3 x 3 Gaussian of the variance
constexpr int passes = 5, least_history = 4;
constexpr float least_share = 0.2f;  // alpha of section 4.1
constexpr float sigma_depth = 1.0f, sigma_normal = 128.0f, sigma_visibility = 4.0f;
constexpr float tiny = 1e-6f;

/// Equations 3 and 4: how alike the depth, beside what the surface's slope makes of it, and the normal are.
float surface_weight(const Guide& p, const Guide& q, int dx, int dy) {
  const float slope =
      std::abs(p.depth_slope.x * static_cast<float>(dx) + p.depth_slope.y * static_cast<float>(dy));
  const float depth = std::abs(p.depth - q.depth) / (sigma_depth * slope + tiny * p.depth + tiny);
  return std::pow(std::max(0.0f, glm::dot(p.normal, q.normal)), sigma_normal) * std::exp(-depth);
}

template <std::size_t count>
class Svgf final : public Denoiser<count> {
 public:
  explicit Svgf(ImageSize size)
      : size_(size),
        history_(size, all_of<count>(1.0f)),
        moments_(size),
        held_(size),
        variance_(size),
        spare_variance_(size) {}

  std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) override {
    std::uint64_t taps = accumulate(frame);
    taps += estimate_variance(frame.guides);
    Image<Signal<count>> in = history_;
    for (int pass = 0; pass < passes; ++pass) {
      taps += filter(frame.guides, pass, in, out);
      std::swap(variance_, spare_variance_);
      if (pass == 0) history_ = out;
      if (pass + 1 < passes) std::swap(in, out);
    }
    return taps;
  }
  std::unique_ptr<Denoiser<count>> clone() const override { return std::make_unique<Svgf>(*this); }
  std::uint64_t history_bytes() const override { return size_.pixels() * 4 * sizeof(float); }

 private:
  /// Section 4.1: the running mean of the visibility and of its first two moments.
  std::uint64_t accumulate(const NoisyFrame<count>& frame) {
    const std::uint64_t taps = filter_asked(frame.guides, history_, [&](int x, int y, std::uint64_t& read) {
      float& held = held_.at(x, y);
      held = places_.stays(frame.guides, x, y) ? held + 1.0f : 1.0f;
      const float share = std::max(1.0f / held, least_share);
      const Signal<count>& now = frame.signal.at(x, y);
      const Vec2f moments(now[drawn], now[drawn] * now[drawn]);
      Vec2f& kept = moments_.at(x, y);
      kept = held == 1.0f ? moments : kept + share * (moments - kept);
      if (held == 1.0f) return now;
      ++read;
      Signal<count> mean = between(history_.at(x, y), now, share);
      // The passes then blur this frame's truth alone; what the history's own have made of it is no blur of this frame.
      if constexpr (count > alone) mean[blurred] = frame.moves ? now[blurred] : mean[blurred];
      return mean;
    });
    places_.keep(frame.guides);
    return taps;
  }

  /// Section 4.2: from the moments of the history, or where it is short from those of 7 x 7 pixels.
  std::uint64_t estimate_variance(const Guides& guides) {
    return parallel_reduce(
        static_cast<std::size_t>(size_.height), 8, std::uint64_t{0},
        [&](std::size_t first, std::size_t last, std::uint64_t taps) {
          for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y)
            for (int x = 0; x < size_.width; ++x)
              variance_.at(x, y) = guides.at(x, y).asked() ? variance_at(guides, x, y, taps) : 0.0f;
          return taps;
        },
        [](std::uint64_t a, std::uint64_t b) { return a + b; });
  }

  float variance_at(const Guides& guides, int x, int y, std::uint64_t& taps) const {
    const auto of = [](const Vec2f& m) { return std::max(0.0f, m.y - m.x * m.x); };
    const float held = held_.at(x, y);
    if (held >= least_history) return of(moments_.at(x, y));
    Vec2f sum(0.0f);
    float weights = 0.0f;
    for (int dy = -3; dy <= 3; ++dy)
      for (int dx = -3; dx <= 3; ++dx) {
        if (!lies_in(size_, x + dx, y + dy) || !guides.at(x + dx, y + dy).asked()) continue;
        ++taps;
        const float weight =
            dx == 0 && dy == 0 ? 1.0f : surface_weight(guides.at(x, y), guides.at(x + dx, y + dy), dx, dy);
        sum += weight * moments_.at(x + dx, y + dy), weights += weight;
      }
    return of(sum / weights) * static_cast<float>(least_history) / held;
  }

  float blurred_variance(int x, int y, std::uint64_t& taps) const {
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int qx = std::clamp(x + dx, 0, size_.width - 1), qy = std::clamp(y + dy, 0, size_.height - 1);
        ++taps;
        sum += near_kernel[std::size_t(dx + 1)] * near_kernel[std::size_t(dy + 1)] * variance_.at(qx, qy);
      }
    return sum;
  }

  /// Sections 4.3 and 4.4, equations 1, 2 and 5.
  std::uint64_t filter(const Guides& guides, int pass, const Image<Signal<count>>& in,
                       Image<Signal<count>>& out) {
    const int step = 1 << pass;
    return filter_asked(guides, out, [&](int x, int y, std::uint64_t& taps) {
      const Guide& here = guides.at(x, y);
      const float tolerance = sigma_visibility * std::sqrt(blurred_variance(x, y, taps)) + tiny;
      Signal<count> sum = all_of<count>(0.0f);
      float weights = 0.0f, variance = 0.0f;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
          const int dx = i * step, dy = j * step;
          if (!lies_in(size_, x + dx, y + dy) || !guides.at(x + dx, y + dy).asked()) continue;
          ++taps;
          const Signal<count>& there = in.at(x + dx, y + dy);
          float weight = kernel[std::size_t(i + 2)] * kernel[std::size_t(j + 2)];
          if (i != 0 || j != 0)
            weight *= surface_weight(here, guides.at(x + dx, y + dy), dx, dy) *
                      std::exp(-std::abs(there[drawn] - in.at(x, y)[drawn]) / tolerance);
          add_weighted(weight, there, sum);
          weights += weight, variance += weight * weight * variance_.at(x + dx, y + dy);
        }
      spare_variance_.at(x, y) = variance / (weights * weights);
      return scaled(sum, 1.0f / weights);
    });
  }

  ImageSize size_;
  Places places_;
  Image<Signal<count>> history_;
  Image<Vec2f> moments_;
  Image<float> held_, variance_, spare_variance_;
};

}  // namespace

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_svgf(ImageSize size) {
  return std::make_unique<Svgf<count>>(size);
}
template std::unique_ptr<Denoiser<alone>> make_svgf<alone>(ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_svgf<with_passengers>(ImageSize);

}  // namespace gnomon::rays
