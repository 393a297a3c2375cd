// The denoisers against plain ones in double precision on small images, and what holds of each: what is the same everywhere
// stays so, passengers take the drawing's own weights, and a picture without passengers is the same to the bit.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "rays/denoiser.h"
#include "raytrace/shading/sampling.h"

namespace gnomon::test {
namespace {

using raster::Denoiser;
using rays::alone;
using rays::Guides;
using rays::LightRays;
using rays::Signal;
using rays::with_passengers;

constexpr ImageSize size{24, 20};
constexpr std::array kinds{Denoiser::none, Denoiser::penumbra, Denoiser::atrous, Denoiser::svgf,
                           Denoiser::fidelityfx};

/// A floor seen from above, a pixel a world unit wide, with a step in the middle and some pixels that nothing is asked for.
Guides guides() {
  Guides out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (x == 3 && y < 6) continue;
      const float height = x < 14 ? 0.0f : 5.0f;
      out.at(x, y) = {{float(x), float(y), height}, 1.0f, {0, 0, 1}, 100.0f - height, {0, 0}};
    }
  return out;
}

LightRays noise(std::uint64_t seed, float half_width) {
  LightRays out{Image<float>(size, 1.0f), Image<float>(size, half_width), Image<std::uint32_t>(size, no_id)};
  const Guides where = guides();
  for (std::size_t i = 0; i < out.share.data.size(); ++i) {
    if (!where.data[i].asked()) continue;
    out.source.data[i] = static_cast<std::uint32_t>(i);
    out.share.data[i] = raytrace::sample_key(seed, i) % 3 == 0 ? 0.0f : 1.0f;
  }
  return out;
}

template <std::size_t count>
Image<Signal<count>> signal(const LightRays& rays, float truth) {
  Image<Signal<count>> out(size, rays::all_of<count>(1.0f));
  for (std::size_t i = 0; i < out.data.size(); ++i)
    if (rays.source.data[i] != no_id) {
      out.data[i] = rays::all_of<count>(truth);
      out.data[i][rays::drawn] = rays.share.data[i];
      if constexpr (count > alone) out.data[i][rays::sampled] = rays.share.data[i];
    }
  return out;
}

template <std::size_t count>
Image<Signal<count>> denoised(Denoiser kind, int frames, float truth = 0.25f, float half_width = 8.0f) {
  const auto denoiser =
      rays::make_denoiser<count>({raster::RayCount::one, raster::RaySampler::random, kind, frames}, size);
  Image<Signal<count>> out;
  const Guides where = guides();
  for (int frame = 0; frame < frames; ++frame) {
    const LightRays rays = noise(static_cast<std::uint64_t>(frame) + 1, half_width);
    denoiser->add({where, rays, signal<count>(rays, truth)}, out);
  }
  return out;
}

TEST(Denoisers, PassengersTakeTheDrawingsWeights) {
  for (const Denoiser kind : kinds)
    for (const int frames : {1, 6}) {
      const auto plain = denoised<alone>(kind, frames);
      const auto carried = denoised<with_passengers>(kind, frames);
      const Guides where = guides();
      for (std::size_t i = 0; i < plain.data.size(); ++i) {
        ASSERT_EQ(plain.data[i][rays::drawn], carried.data[i][rays::drawn]) << int(kind);
        if (!where.data[i].asked()) continue;
        // Weights add up to 1, so one truth everywhere comes out as it was.
        EXPECT_NEAR(carried.data[i][rays::blurred], 0.25f, 1e-6f) << int(kind);
        EXPECT_NEAR(carried.data[i][rays::lagged], 0.25f, 1e-6f) << int(kind);
        if (kind == Denoiser::fidelityfx) continue;  // the only one that clamps, and has a contrast
        ASSERT_EQ(carried.data[i][rays::sampled], carried.data[i][rays::drawn]) << int(kind);
      }
    }
}

TEST(Denoisers, KeepAnotherTruthOfNoFrame) {
  // The last frame's truth alone counts as blur, the earlier ones' as lag.
  const auto denoiser = rays::make_denoiser<with_passengers>(
      {raster::RayCount::one, raster::RaySampler::random, Denoiser::none, 4}, size);
  Image<Signal<with_passengers>> out;
  const Guides where = guides();
  for (int frame = 0; frame < 4; ++frame) {
    const LightRays rays = noise(static_cast<std::uint64_t>(frame), 0.0f);
    denoiser->add({where, rays, signal<with_passengers>(rays, frame == 3 ? 1.0f : 0.0f)}, out);
  }
  EXPECT_FLOAT_EQ(out.at(10, 10)[rays::blurred], 1.0f);
  EXPECT_FLOAT_EQ(out.at(10, 10)[rays::lagged], 0.25f);
}

TEST(Denoisers, BlurIsOfThisFramesTruthThoughItsHistoryHoldsOthers) {
  for (const Denoiser kind : kinds) {
    const auto denoiser = rays::make_denoiser<with_passengers>(
        {raster::RayCount::one, raster::RaySampler::random, kind, 8}, size);
    Image<Signal<with_passengers>> out;
    const Guides where = guides();
    for (int frame = 0; frame < 6; ++frame) {
      const LightRays rays = noise(static_cast<std::uint64_t>(frame), 8.0f);
      denoiser->add({where, rays, signal<with_passengers>(rays, frame == 5 ? 1.0f : 0.0f), true}, out);
    }
    for (std::size_t i = 0; i < out.data.size(); ++i) {
      if (!where.data[i].asked()) continue;
      EXPECT_NEAR(out.data[i][rays::blurred], 1.0f, 1e-5f) << int(kind);  // rounding of means of equal floats
      EXPECT_LT(out.data[i][rays::lagged], 0.95f) << int(kind) << ": five frames were dark";
    }
  }
}

TEST(Denoisers, HistoryIsGivenUpWhereAPixelShowsAnotherPlace) {
  for (const Denoiser kind : kinds) {
    const auto make = [&] {
      return rays::make_denoiser<alone>({raster::RayCount::one, raster::RaySampler::random, kind, 8}, size);
    };
    const auto held = make(), fresh = make();
    Image<Signal<alone>> after, first;
    const Guides before = guides();
    Guides moved = before;
    for (auto& guide : moved.data) guide.place.y += 40.0f;
    const LightRays then = noise(1, 8.0f), now = noise(2, 8.0f);
    held->add({before, then, signal<alone>(then, 0.0f)}, after);
    held->add({moved, now, signal<alone>(now, 0.0f), true}, after);
    fresh->add({moved, now, signal<alone>(now, 0.0f)}, first);
    EXPECT_EQ(after.data, first.data) << int(kind);
  }
}

// A plain à-trous, as the paper's equations stand.
double plain_atrous(const Guides& where, const Image<double>& in, int x, int y, int step, double tolerance) {
  constexpr std::array h{1.0 / 16.0, 0.25, 0.375, 0.25, 1.0 / 16.0};
  double sum = 0.0, weights = 0.0;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) {
      const int qx = x + (i - 2) * step, qy = y + (j - 2) * step;
      if (qx < 0 || qy < 0 || qx >= size.width || qy >= size.height || !where.at(qx, qy).asked()) continue;
      const double apart = (in.at(qx, qy) - in.at(x, y)) / tolerance;
      const Vec3f moved = where.at(qx, qy).place - where.at(x, y).place;
      const double weight = h[std::size_t(i)] * h[std::size_t(j)] * std::exp(-apart * apart) *
                            std::exp(-double(glm::dot(moved, moved)) / (32.0 * 32.0));
      sum += weight * in.at(qx, qy), weights += weight;
    }
  return sum / weights;
}

TEST(Denoisers, ATrousIsThePapers) {
  const Guides where = guides();
  const LightRays rays = noise(1, 8.0f);
  Image<double> picture(size, 1.0);
  for (std::size_t i = 0; i < picture.data.size(); ++i) picture.data[i] = rays.share.data[i];
  for (const int step : {1, 2, 4, 8, 16}) {
    Image<double> next(size, 1.0);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (where.at(x, y).asked()) next.at(x, y) = plain_atrous(where, picture, x, y, step, 1.0 / step);
    picture = next;
  }
  const auto out = denoised<alone>(Denoiser::atrous, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    EXPECT_NEAR(out.data[i][rays::drawn], picture.data[i], 2e-5);  // five passes of floats
}

// One pass of the Gaussian, along x or y, of deviation 2: a quarter of the half width of 8. What lies on the step's other side
// is off the plane.
Image<double> plain_gaussian(const Guides& where, const Image<double>& in, int dx, int dy) {
  Image<double> out(size, 1.0);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (!where.at(x, y).asked()) continue;
      double sum = 0.0, weights = 0.0;
      for (int k = -5; k <= 5; ++k) {
        const int qx = x + k * dx, qy = y + k * dy;
        if (qx < 0 || qy < 0 || qx >= size.width || qy >= size.height || !where.at(qx, qy).asked()) continue;
        if (where.at(qx, qy).place.z != where.at(x, y).place.z) continue;
        const double weight = std::exp(-k * k / (2.0 * 2.0 * 2.0));
        sum += weight * in.at(qx, qy), weights += weight;
      }
      out.at(x, y) = sum / weights;
    }
  return out;
}

TEST(Denoisers, PenumbraIsAGaussianOfAQuarterOfItsHalfWidth) {
  const Guides where = guides();
  const LightRays rays = noise(1, 8.0f);
  Image<double> picture(size, 1.0);
  for (std::size_t i = 0; i < picture.data.size(); ++i) picture.data[i] = rays.share.data[i];
  picture = plain_gaussian(where, plain_gaussian(where, picture, 1, 0), 0, 1);
  const auto out = denoised<alone>(Denoiser::penumbra, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    EXPECT_NEAR(out.data[i][rays::drawn], picture.data[i], 2e-6);
}

TEST(Denoisers, PenumbraOfNoBlockerIsLeftAlone) {
  const auto out = denoised<alone>(Denoiser::penumbra, 1, 0.25f, 0.0f);
  const LightRays rays = noise(1, 0.0f);
  for (std::size_t i = 0; i < out.data.size(); ++i) EXPECT_EQ(out.data[i][rays::drawn], rays.share.data[i]);
}

TEST(Denoisers, MeanOfManyFramesNearsTheShare) {
  // Two thirds arrive. Sixty-four frames of one ray have a standard error of 0.059, of which five hold 468 pixels.
  const auto out = denoised<alone>(Denoiser::none, 64);
  const Guides where = guides();
  for (std::size_t i = 0; i < out.data.size(); ++i)
    if (where.data[i].asked()) {
      EXPECT_NEAR(out.data[i][rays::drawn], 2.0 / 3.0, 5.0 * 0.059);
    }
}

TEST(Denoisers, ContrastDarkensAsItsSourceSays) {
  // All lit or all dark: no variance is left after sixteen frames, and the power of 1.2 keeps both ends.
  for (const float share : {0.0f, 1.0f}) {
    const auto denoiser = rays::make_denoiser<alone>(
        {raster::RayCount::one, raster::RaySampler::random, Denoiser::fidelityfx, 20}, size);
    Image<Signal<alone>> out;
    const Guides where = guides();
    LightRays rays = noise(1, 0.0f);
    for (std::size_t i = 0; i < rays.share.data.size(); ++i)
      if (rays.source.data[i] != no_id) rays.share.data[i] = share;
    for (int frame = 0; frame < 20; ++frame) denoiser->add({where, rays, signal<alone>(rays, 0.0f)}, out);
    for (std::size_t i = 0; i < out.data.size(); ++i)
      if (where.data[i].asked()) {
        EXPECT_NEAR(out.data[i][rays::drawn], share, 1e-5f);  // rounding of means of equal floats
      }
  }
}

TEST(Denoisers, CopiesGoOnWithTheSameHistory) {
  for (const Denoiser kind : kinds) {
    const auto denoiser =
        rays::make_denoiser<alone>({raster::RayCount::one, raster::RaySampler::random, kind, 8}, size);
    Image<Signal<alone>> first, second;
    const Guides where = guides();
    const LightRays before = noise(1, 8.0f), now = noise(2, 8.0f);
    denoiser->add({where, before, signal<alone>(before, 0.0f)}, first);
    const auto copy = denoiser->clone();
    denoiser->add({where, now, signal<alone>(now, 0.0f)}, first);
    copy->add({where, now, signal<alone>(now, 0.0f)}, second);
    EXPECT_EQ(first.data, second.data) << int(kind);
  }
}

}  // namespace
}  // namespace gnomon::test
