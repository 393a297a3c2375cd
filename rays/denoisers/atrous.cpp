// The edge-avoiding à-trous wavelet: Dammertz, Sewtz, Hanika and Lensch 2010, "Edge-Avoiding À-Trous Wavelet Transform for fast
// Global Illumination Filtering", equations 2 to 5. Five passes read 5 x 5 values that lie 1, 2, 4, 8 and 16 pixels apart. They are
// weighed by the spline's kernel and by how alike visibility, normal and place are. The tolerance of visibility is halved from
// pass to pass.
#include <array>

#include "rays/mean_history.h"

namespace gnomon::rays {
namespace {

constexpr std::array kernel{1.0f / 16.0f, 1.0f / 4.0f, 3.0f / 8.0f, 1.0f / 4.0f, 1.0f / 16.0f};
constexpr int passes = 5;
// The deviations of the edge-stopping functions: of visibilities in the first pass, of unit normals, of places in pixels.
constexpr float of_visibility = 1.0f, of_normal = 0.35f, of_place = 32.0f;

template <std::size_t count>
class ATrous final : public Denoiser<count> {
 public:
  ATrous(int frames, ImageSize size) : history_(frames, size) {}

  std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) override {
    std::uint64_t taps = history_.add(frame);
    in_ = history_.mean();
    for (int pass = 0; pass < passes; ++pass) {
      taps += filter(frame.guides, pass, out);
      if (pass + 1 < passes) std::swap(in_, out);
    }
    return taps;
  }
  std::unique_ptr<Denoiser<count>> clone() const override { return std::make_unique<ATrous>(*this); }
  std::uint64_t history_bytes() const override { return history_.bytes(); }

 private:
  std::uint64_t filter(const Guides& guides, int pass, Image<Signal<count>>& out) const {
    const int step = 1 << pass;
    const float visibility = of_visibility / static_cast<float>(step);
    return filter_asked(guides, out, [&](int x, int y, std::uint64_t& taps) {
      const Guide& here = guides.at(x, y);
      const Signal<count>& own = in_.at(x, y);
      Signal<count> sum = all_of<count>(0.0f);
      float weights = 0.0f;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
          const int qx = x + i * step, qy = y + j * step;
          if (!lies_in(guides.size, qx, qy) || !guides.at(qx, qy).asked()) continue;
          ++taps;
          const Guide& there = guides.at(qx, qy);
          const float apart = (in_.at(qx, qy)[drawn] - own[drawn]) / visibility;
          const Vec3f turned = (there.normal - here.normal) / of_normal;
          const Vec3f moved = (there.place - here.place) / (of_place * here.footprint);
          const float weight = kernel[std::size_t(i + 2)] * kernel[std::size_t(j + 2)] *
                               std::exp(-apart * apart - glm::dot(turned, turned) - glm::dot(moved, moved));
          add_weighted(weight, in_.at(qx, qy), sum), weights += weight;
        }
      return scaled(sum, 1.0f / weights);
    });
  }

  MeanHistory<count> history_;
  Image<Signal<count>> in_;
};

}  // namespace

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_atrous(int frames, ImageSize size) {
  return std::make_unique<ATrous<count>>(frames, size);
}
template std::unique_ptr<Denoiser<alone>> make_atrous<alone>(int, ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_atrous<with_passengers>(int, ImageSize);

}  // namespace gnomon::rays
