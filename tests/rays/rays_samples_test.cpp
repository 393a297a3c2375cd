// Where few rays go, and what they say before any denoiser: the samplers' points, the mask of blue noise, and the noise against
// its closed form p (1 - p) / n (Bernoulli).
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <numeric>
#include <set>

#include "rays/frames.h"
#include "rays/ray_samples.h"
#include "raytrace/receiver_tiles.h"
#include "raytrace/shading/light_samples.h"
#include "scene/load.h"
#include "tests/support/raytrace_support.h"

namespace gnomon::test {
namespace {

using raster::RayCount;
using raster::RaySampler;
using rays::PixelRays;
using rays::RaySquare;

constexpr std::array samplers{RaySampler::random, RaySampler::stratified, RaySampler::blue_noise};

TEST(BlueNoiseMask, HoldsEachRankOnce) {
  const auto& mask = rays::blue_noise_mask();
  std::set<std::uint16_t> ranks(mask.begin(), mask.end());
  EXPECT_EQ(ranks.size(), mask.size());
  EXPECT_EQ(*ranks.rbegin(), mask.size() - 1);
}

/// The mean power of the frequencies between two radii, in waves across the mask; of white noise of that variance it is 1.
double power_between(double from, double to) {
  constexpr auto side = static_cast<int>(rays::mask_side);
  const auto& mask = rays::blue_noise_mask();
  const double count = double(mask.size()), middle = 0.5 * (count - 1.0),
               variance = (count * count - 1.0) / 12.0;
  double sum = 0.0;
  int frequencies = 0;
  for (int u = -side / 2; u < side / 2; ++u)
    for (int v = -side / 2; v < side / 2; ++v) {
      const double radius = std::hypot(u, v);
      if (radius < from || radius >= to) continue;
      std::complex<double> wave = 0.0;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          wave += (mask[std::size_t(y * side + x)] - middle) *
                  std::polar(1.0, -2.0 * std::numbers::pi * (u * x + v * y) / side);
      sum += std::norm(wave) / (count * variance), ++frequencies;
    }
  return sum / frequencies;
}

TEST(BlueNoiseMask, HasLittleOfLowFrequencies) {
  EXPECT_LT(power_between(1.0, 5.0), 0.05);
  EXPECT_GT(power_between(10.0, 16.0), 1.0);
}

TEST(RaySquare, IsUniformForEverySampler) {
  for (const RaySampler sampler : samplers) {
    Vec2 mean(0.0), square(0.0);
    constexpr std::uint32_t side = 64, count = 4;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        for (std::uint32_t i = 0; i < count; ++i) {
          const Vec2 p = RaySquare(sampler, {x, y, 3, count, raytrace::sample_key(7, y * side + x)})[i];
          ASSERT_TRUE(p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0);
          mean += p, square += p * p;
        }
    constexpr double points = double(side) * side * count;
    for (int axis = 0; axis < 2; ++axis) {
      // Four standard errors of 16,384 points that know nothing of each other.
      EXPECT_NEAR(mean[axis] / points, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / points));
      EXPECT_NEAR(square[axis] / points, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / points));
    }
  }
}

TEST(RaySquare, SaysTheSameAgainAndAnotherThingForTheNextFrame) {
  for (const RaySampler sampler : samplers) {
    const PixelRays first{5, 9, 0, 4, 77}, next{5, 9, 1, 4, 77};
    EXPECT_EQ(RaySquare(sampler, first)[2], RaySquare(sampler, first)[2]);
    EXPECT_NE(RaySquare(sampler, first)[2], RaySquare(sampler, next)[2]);
  }
}

TEST(RaySquare, StratifiedPointsShareNoColumn) {
  const RaySquare square(RaySampler::stratified, {1, 2, 0, 16, 5});
  std::set<int> columns;
  for (std::uint32_t i = 0; i < 16; ++i) columns.insert(static_cast<int>(square[i].x * 16.0));
  EXPECT_EQ(columns.size(), 16u);
}

/// A picture's receivers under its first light, and the truth of many samples.
struct Picture {
  explicit Picture(const std::string& name)
      : scene(load_scene(name).value()), world(make_world(scene)), tracer(world, raytrace::Accel::bvh) {
    const View view = make_view(scene.camera, {160, 90});
    Image<std::uint32_t> primitive(view.size, no_id);
    for (int y = 0; y < view.size.height; ++y)
      for (int x = 0; x < view.size.width; ++x)
        if (const auto hit = tracer.closest_seen(pixel_ray(view, x + 0.5, y + 0.5)))
          primitive.at(x, y) = hit->primitive;
    raytrace::ReceiverFinder(tracer).find(view, 0, primitive, receivers);
    guides = rays::make_guides(tracer, view, 0, scene.lights[0], receivers.points);
    truth = Image<float>(view.size, 1.0f);
    for (std::size_t i = 0; i < truth.data.size(); ++i)
      if (guides.data[i].asked())
        truth.data[i] = static_cast<float>(light_visibility(tracer, receivers.points.data[i], scene.lights[0],
                                                            1024, raytrace::sample_key(3, i))
                                               .share);
  }
  rays::LightRays cast(RayCount count, RaySampler sampler, std::uint32_t frame = 0) const {
    return rays::cast_rays(tracer, {{count, sampler, raster::Denoiser::none, 1}, 11, 0, frame, 0}, guides,
                           receivers.points);
  }
  /// The mean square of the rays' error, over the pixels that are asked.
  double variance(RayCount count, RaySampler sampler) const {
    double sum = 0.0;
    std::size_t asked = 0;
    constexpr std::uint32_t frames = 40;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      const rays::LightRays rays = cast(count, sampler, frame);
      for (std::size_t i = 0; i < truth.data.size(); ++i)
        if (guides.data[i].asked()) sum += std::pow(double(rays.share.data[i]) - truth.data[i], 2), ++asked;
    }
    return sum / double(asked);
  }
  Scene scene;
  World world;
  raytrace::Tracer tracer;
  raytrace::Receivers receivers;
  rays::Guides guides;
  Image<float> truth;
};

TEST(LightRays, NoiseOfRandomRaysIsBernoullis) {
  const Picture picture("penumbra");
  double expected = 0.0;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < picture.truth.data.size(); ++i)
    if (picture.guides.data[i].asked())
      expected += double(picture.truth.data[i]) * (1.0 - picture.truth.data[i]), ++asked;
  expected /= double(asked);
  // 40 frames of some 700 pixels in the penumbra: the sum of squares is known to about 1 %.
  for (const auto& [count, n] :
       {std::pair(RayCount::one, 1.0), std::pair(RayCount::four, 4.0), std::pair(RayCount::sixteen, 16.0)})
    EXPECT_NEAR(picture.variance(count, RaySampler::random) / (expected / n), 1.0, 0.04) << n;
}

TEST(LightRays, NoiseFallsFasterWhereRaysAreSpread) {
  const Picture picture("penumbra");
  const auto slope = [&](RaySampler sampler) {
    return 0.5 *
           std::log2(picture.variance(RayCount::sixteen, sampler) /
                     picture.variance(RayCount::one, sampler)) /
           4.0;
  };
  EXPECT_NEAR(slope(RaySampler::random), -0.5, 0.02);
  EXPECT_LT(slope(RaySampler::stratified), -0.65);
  EXPECT_LT(slope(RaySampler::blue_noise), -0.65);
}

TEST(LightRays, OneRayForFourPixelsIsThatOfTheirBlock) {
  const Picture picture("penumbra");
  const rays::LightRays quarter = picture.cast(RayCount::quarter, RaySampler::random),
                        one = picture.cast(RayCount::one, RaySampler::random);
  EXPECT_LT(quarter.rays, one.rays / 3);
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 160; ++x) {
      const std::uint32_t source = quarter.source.at(x, y);
      if (source == no_id) continue;
      EXPECT_EQ(int(source % 160) / 2, x / 2);
      EXPECT_EQ(int(source / 160) / 2, y / 2);
      EXPECT_EQ(quarter.share.at(x, y), one.share.data[source]);
    }
}

TEST(LightRays, PenumbraIsThatOfSimilarTriangles) {
  Light lamp = point_light({0, 8, 0});
  lamp.extent = SphereLight{0.5};
  EXPECT_DOUBLE_EQ(rays::penumbra_half_width(lamp, 8.0, 2.0), 0.5 * 2.0 / 6.0);
  Light far = sun({0, -1, 0});
  far.extent = SunDisc{0.02};
  EXPECT_NEAR(rays::penumbra_half_width(far, std::numeric_limits<double>::infinity(), 3.0),
              3.0 * std::tan(0.01), 1e-12);
}

}  // namespace
}  // namespace gnomon::test
