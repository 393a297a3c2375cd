#include "rays/ray_samples.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "raytrace/shading/sampling.h"

namespace gnomon::rays {
namespace {

// R2: the fractions of the plastic number's powers.
constexpr double plastic = 1.32471795724474602596;
constexpr Vec2 r2_step(1.0 / plastic, 1.0 / (plastic * plastic));

double mask_value(std::uint32_t x, std::uint32_t y) {
  const auto& mask = blue_noise_mask();
  return (mask[(y % mask_side) * mask_side + x % mask_side] + 0.5) / static_cast<double>(mask.size());
}

Vec2 wrapped(const Vec2& p) {
  return p - glm::floor(p);
}

}  // namespace

RaySquare::RaySquare(raster::RaySampler sampler, const PixelRays& pixel)
    : sampler_(sampler), pixel_(pixel), frame_key_(raytrace::sample_key(pixel.key, pixel.frame)) {
  if (sampler != raster::RaySampler::blue_noise) return;
  // Half a mask apart along both axes the two values know nothing of each other.
  constexpr std::uint32_t apart = mask_side / 2;
  shift_ = {mask_value(pixel.x, pixel.y), mask_value(pixel.x + apart, pixel.y + apart + 5)};
}

Vec2 RaySquare::operator[](std::uint32_t i) const {
  switch (sampler_) {
    case raster::RaySampler::random: {
      const std::uint64_t bits = raytrace::sample_key(frame_key_, i);
      return {static_cast<std::uint32_t>(bits) * 0x1p-32, static_cast<std::uint32_t>(bits >> 32) * 0x1p-32};
    }
    case raster::RaySampler::stratified:
      return raytrace::StratifiedSquare(pixel_.count, frame_key_)[i];
    case raster::RaySampler::blue_noise:
      break;
  }
  const double number = double(pixel_.frame) * pixel_.count + i;
  return wrapped(shift_ + number * r2_step);
}

namespace {

/// The void-and-cluster method on a torus. A pixel's energy is the sum of the Gaussians around all points.
class VoidAndCluster {
 public:
  static constexpr std::uint32_t side = mask_side, pixels = side * side;
  using Mask = std::array<std::uint16_t, pixels>;

  VoidAndCluster() {
    constexpr double sigma = 1.5, scale = 0x1p24;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x) {
        const double dx = std::min(x, side - x), dy = std::min(y, side - y);
        gaussian_[y * side + x] =
            std::llround(scale * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma)));
      }
  }

  Mask make() {
    start();
    Mask mask{};
    const auto first = points_;
    const auto first_energy = energy_;
    for (std::uint32_t rank = count_; rank-- > 0;) {  // the first pattern's points, the tightest last
      const std::uint32_t at = tightest();
      set(at, false);
      mask[at] = static_cast<std::uint16_t>(rank);
    }
    points_ = first, energy_ = first_energy;
    for (std::uint32_t rank = first_count; rank < pixels; ++rank) {
      const std::uint32_t at = emptiest();
      set(at, true);
      mask[at] = static_cast<std::uint16_t>(rank);
    }
    return mask;
  }

 private:
  static constexpr std::uint32_t first_count = pixels / 10;

  /// A tenth of the pixels, spread evenly: the tightest point goes to the emptiest place until it stays.
  void start() {
    for (std::uint32_t i = 0; count_ < first_count; ++i) {
      const auto at = static_cast<std::uint32_t>(raytrace::mix_bits(i) % pixels);
      if (!points_[at]) set(at, true);
    }
    for (;;) {
      const std::uint32_t from = tightest();
      set(from, false);
      const std::uint32_t to = emptiest();
      set(to, true);
      if (to == from) return;
    }
  }

  void set(std::uint32_t at, bool point) {
    points_[at] = point;
    count_ += point ? 1u : ~0u;
    const std::uint32_t px = at % side, py = at / side;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x) {
        const std::int64_t energy = gaussian_[(y + side - py) % side * side + (x + side - px) % side];
        energy_[y * side + x] += point ? energy : -energy;
      }
  }

  /// The point with the most around it; of equal ones the first.
  std::uint32_t tightest() const {
    std::uint32_t best = pixels;
    for (std::uint32_t i = 0; i < pixels; ++i)
      if (points_[i] && (best == pixels || energy_[i] > energy_[best])) best = i;
    return best;
  }

  /// The place without a point that has the least around it; of equal ones the first.
  std::uint32_t emptiest() const {
    std::uint32_t best = pixels;
    for (std::uint32_t i = 0; i < pixels; ++i)
      if (!points_[i] && (best == pixels || energy_[i] < energy_[best])) best = i;
    return best;
  }

  std::array<std::int64_t, pixels> gaussian_{}, energy_{};
  std::array<bool, pixels> points_{};
  std::uint32_t count_ = 0;
};

}  // namespace

const std::array<std::uint16_t, mask_side * mask_side>& blue_noise_mask() {
  static const auto mask = [] {
    const auto maker = std::make_unique<VoidAndCluster>();
    return std::make_unique<VoidAndCluster::Mask>(maker->make());
  }();
  return *mask;
}

}  // namespace gnomon::rays
