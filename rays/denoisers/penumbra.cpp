// A Gaussian as wide as the penumbra asks for: after Mehta, Wang and Ramamoorthi 2012, "Axis-Aligned Filtering for Interactive
// Sampled Soft Shadows". What a ray met tells how wide the penumbra is; a filter that is narrow against it takes the noise and
// leaves the shadow. Two passes, along rows and along columns, each with the pixel's own width.
//
// The Gaussian's standard deviation is a quarter of half the penumbra's width (share_of_penumbra). A ray that arrives tells
// nothing, so the widest penumbra counts that any of the 5 x 5 pixels around tells. Distances are those of the places on the surface, and
// what lies off the pixel's tangent plane, or is turned otherwise, counts nothing.
#include "rays/mean_history.h"

namespace gnomon::rays {
namespace {

constexpr float share_of_penumbra = 0.25f;
constexpr float reach_in_deviations = 2.5f;
constexpr int most_pixels = 32;       // that a pass reads to either side
constexpr float least_cosine = 0.9f;  // of the angle between normals

template <std::size_t count>
class Penumbra final : public Denoiser<count> {
 public:
  Penumbra(int frames, ImageSize size) : history_(frames, size), deviation_(size) {}

  std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) override {
    std::uint64_t taps = history_.add(frame);
    taps += find_deviations(frame.guides);
    taps += pass(frame.guides, history_.mean(), 1, 0, rows_);
    return taps + pass(frame.guides, rows_, 0, 1, out);
  }
  std::unique_ptr<Denoiser<count>> clone() const override { return std::make_unique<Penumbra>(*this); }
  std::uint64_t history_bytes() const override { return history_.bytes(); }

 private:
  std::uint64_t find_deviations(const Guides& guides) {
    const Image<float>& half_width = history_.half_width();
    return parallel_reduce(
        static_cast<std::size_t>(guides.size.height), 8, std::uint64_t{0},
        [&](std::size_t first, std::size_t last, std::uint64_t taps) {
          for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y)
            for (int x = 0; x < guides.size.width; ++x)
              deviation_.at(x, y) = share_of_penumbra * widest_around(half_width, guides, x, y, taps);
          return taps;
        },
        [](std::uint64_t a, std::uint64_t b) { return a + b; });
  }

  static float widest_around(const Image<float>& half_width, const Guides& guides, int x, int y,
                             std::uint64_t& taps) {
    if (!guides.at(x, y).asked()) return 0.0f;
    float widest = 0.0f;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        if (!lies_in(guides.size, x + dx, y + dy)) continue;
        ++taps;
        widest = std::max(widest, half_width.at(x + dx, y + dy));
      }
    return widest;
  }

  std::uint64_t pass(const Guides& guides, const Image<Signal<count>>& in, int dx, int dy,
                     Image<Signal<count>>& out) const {
    return filter_asked(guides, out, [&](int x, int y, std::uint64_t& taps) {
      const Guide& here = guides.at(x, y);
      const float deviation = deviation_.at(x, y);
      const int reach = std::min(
          static_cast<int>(std::ceil(reach_in_deviations * deviation / here.footprint)), most_pixels);
      Signal<count> sum = in.at(x, y);
      float weights = 1.0f;
      for (int k = -reach; k <= reach; ++k) {
        const int qx = x + k * dx, qy = y + k * dy;
        if (k == 0 || !lies_in(guides.size, qx, qy)) continue;
        ++taps;
        const float weight = weight_of(here, guides.at(qx, qy), deviation);
        add_weighted(weight, in.at(qx, qy), sum), weights += weight;
      }
      return scaled(sum, 1.0f / weights);
    });
  }

  static float weight_of(const Guide& p, const Guide& q, float deviation) {
    if (!q.asked() || glm::dot(p.normal, q.normal) < least_cosine) return 0.0f;
    const Vec3f way = q.place - p.place;
    const float squared = glm::dot(way, way);
    if (off_plane(p, q) > p.footprint + 0.1f * std::sqrt(squared)) return 0.0f;
    return std::exp(-squared / (2.0f * deviation * deviation));
  }

  MeanHistory<count> history_;
  Image<float> deviation_;  // world units
  Image<Signal<count>> rows_;
};

}  // namespace

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_penumbra(int frames, ImageSize size) {
  return std::make_unique<Penumbra<count>>(frames, size);
}
template std::unique_ptr<Denoiser<alone>> make_penumbra<alone>(int, ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_penumbra<with_passengers>(int, ImageSize);

}  // namespace gnomon::rays
