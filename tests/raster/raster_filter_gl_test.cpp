// Every filtering technique's drawn visibility against its formula in double precision on the depth map read
// back (raster_filter_reference.h).
#include "tests/raster/raster_filter_reference.h"

namespace gnomon::test {
namespace {

using raster::FilterKernel;
using raster::Technique;

class Filter : public testing::TestWithParam<LightType> {
 protected:
  /// Draws, and holds every receiver's visibility against reference(receiver, ambiguous); those that are so are left
  /// out.
  void compare(const raster::RasterOptions& options, double tolerance,
               const std::function<double(const Drawn&, const FilterReceiver&, bool&)>& reference) {
    const Drawn drawn = draw(lit_still_life(GetParam()), options);
    ASSERT_FALSE(drawn.frame.lights.empty());
    int tested = 0, between = 0, left_out = 0;
    for_receivers(drawn, 6.0, [&](const FilterReceiver& r) {
      bool ambiguous = false;
      const double expected = reference(drawn, r, ambiguous);
      if (ambiguous) {
        ++left_out;
        return;
      }
      const double visibility = drawn.light().visibility.data[r.pixel];
      ++tested;
      between += visibility > 0.0 && visibility < 1.0 ? 1 : 0;
      ASSERT_NEAR(visibility, expected, tolerance) << "at " << r.at.u << ", " << r.at.v;
    });
    EXPECT_GT(tested, 4000);
    EXPECT_GT(between, 100);
    EXPECT_LT(left_out, tested);
  }
};

// A rounding error may choose other texels near a texel's border.
bool near_border(double texels) {
  return std::abs(texels - std::round(texels)) < 1e-3;
}

double box_mean(const Drawn& drawn, const FilterReceiver& r, int radius, bool& ambiguous) {
  ambiguous = ambiguous || near_border(r.at.u) || near_border(r.at.v);
  double sum = 0.0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i)
      sum += lit_at(drawn, r, r.at.column() + i, r.at.row() + j, ambiguous);
  return sum / ((2 * radius + 1) * (2 * radius + 1));
}

// Sums of at most 49 equal weights, in float.
constexpr double sum_tolerance = 1e-5;

TEST_P(Filter, BoxIsTheMeanOfHardTests) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.radius_texels = 2.5;
  compare(options, sum_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& ambiguous) {
    return box_mean(drawn, r, 2, ambiguous);
  });
}

TEST_P(Filter, ReceiverPlaneTakesThePlanesDepthAtEachTap) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.radius_texels = 3.5;
  options.map.bias.constant = 0.2;
  options.map.bias.receiver_plane = true;
  compare(options, sum_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& ambiguous) {
    return box_mean(drawn, r, 3, ambiguous);
  });
}

// The share of a texel of a row that a square around the receiver covers.
double covered(int texel, double middle, double radius) {
  return std::clamp(std::min(texel + 1.0, middle + radius) - std::max(double(texel), middle - radius), 0.0,
                    1.0);
}

double square_mean(const Drawn& drawn, const FilterReceiver& r, double radius, bool& ambiguous) {
  double sum = 0.0;
  const int reach = static_cast<int>(std::ceil(radius)) + 1;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double weight =
          covered(r.at.column() + i, r.at.u, radius) * covered(r.at.row() + j, r.at.v, radius);
      if (weight > 0.0) sum += weight * lit_at(drawn, r, r.at.column() + i, r.at.row() + j, ambiguous);
    }
  return sum / (4.0 * radius * radius);
}

// Texel positions of some hundred carry a rounding of 1e-5 into the weights; a few of them add up.
constexpr double weight_tolerance = 4e-4;

TEST_P(Filter, HardwareIsTheBilinearMeanOfFour) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::hardware;
  compare(options, weight_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& ambiguous) {
    return square_mean(drawn, r, 0.5, ambiguous);
  });
}

TEST_P(Filter, OptimisedWeighsTexelsByTheirOverlap) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::optimised;
  for (const double radius : {1.0, 1.7, 2.5}) {
    options.map.filter.radius_texels = radius;
    compare(options, weight_tolerance,
            [radius](const Drawn& drawn, const FilterReceiver& r, bool& ambiguous) {
              return square_mean(drawn, r, radius, ambiguous);
            });
  }
}

// The turn differs from pixel to pixel; what must hold is that taps are at most a radius away, and many make
// the mean over the disc.
TEST_P(Filter, VogelIsTheMeanOverADisc) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::vogel;
  options.map.filter.radius_texels = 3.0;
  options.map.filter.samples = 512;
  // 512 evenly spread points: each cell of the disc is found to about one point in sqrt(512).
  compare(options, 0.05, [](const Drawn& drawn, const FilterReceiver& r, bool& ambiguous) {
    double sum = 0.0;
    int count = 0;
    bool any = false;
    constexpr int grid = 48;
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) {
        const Vec2 p((2.0 * i + 1.0) / grid - 1.0, (2.0 * j + 1.0) / grid - 1.0);
        if (glm::dot(p, p) > 1.0) continue;
        ++count;
        sum += lit_at(drawn, r, static_cast<int>(std::floor(r.at.u + 3.0 * p.x)),
                      static_cast<int>(std::floor(r.at.v + 3.0 * p.y)), any);
      }
    ambiguous = any;
    return sum / count;
  });
}

/// The reference of a technique of moments: blurred and read bilinearly, then `visibility` of the moments and
/// the receiver's biased share.
template <class Moments, class Visibility>
auto moment_reference(const Moments& moments, const Visibility& visibility) {
  auto faces = std::make_shared<std::map<int, BlurredFace>>();
  return [=](const Drawn& drawn, const FilterReceiver& r, bool&) {
    const auto& map = drawn.light().map;
    const int radius = drawn.frame.options.map.filter.blur_radius_texels;
    auto found = faces->find(r.at.face);
    if (found == faces->end())
      found = faces->emplace(r.at.face, BlurredFace(map, r.at.face, radius, moments)).first;
    return visibility(found->second.bilinear(r.at.u, r.at.v),
                      BlurredFace::share(map.view, r.at.distance - r.slack));
  };
}

TEST_P(Filter, VsmIsChebyshevsBound) {
  raster::RasterOptions options = technique_options(Technique::vsm);
  options.map.filter.light_bleeding_reduction = 0.3;
  // The variance is a difference of squares: rounding of 2^-24 against a variance of 1e-4 and less.
  compare(options, 0.02,
          moment_reference(
              [](double z) {
                return BlurredFace::Value{z, z * z, 0, 0};
              },
              [](const BlurredFace::Value& m, double x) {
                return std::clamp((judge::chebyshev(m[0], m[1], x) - 0.3) / 0.7, 0.0, 1.0);
              }));
}

TEST_P(Filter, EsmIsTheMeanExponential) {
  raster::RasterOptions options = technique_options(Technique::esm);
  options.map.filter.esm_exponent = 60.0;
  compare(options, 2e-3,
          moment_reference(
              [](double z) {
                return BlurredFace::Value{std::exp(60.0 * z), 0, 0, 0};
              },
              [](const BlurredFace::Value& m, double x) {
                return std::clamp(m[0] * std::exp(-60.0 * x), 0.0, 1.0);
              }));
}

TEST_P(Filter, EvsmIsTheSmallerOfTwoBounds) {
  raster::RasterOptions options = technique_options(Technique::evsm);
  options.map.filter.light_bleeding_reduction = 0.0;
  options.map.filter.evsm_positive_exponent = 20.0;
  const auto warp = [](double share) {
    const double z = 2.0 * share - 1.0;
    return std::pair(std::exp(20.0 * z), -std::exp(-5.0 * z));
  };
  compare(options, 0.02,
          moment_reference(
              [warp](double share) {
                const auto [p, n] = warp(share);
                return BlurredFace::Value{p, p * p, n, n * n};
              },
              [warp](const BlurredFace::Value& m, double x) {
                const auto [p, n] = warp(x);
                return std::min(judge::chebyshev(m[0], m[1], p), judge::chebyshev(m[2], m[3], n));
              }));
}

TEST_P(Filter, MsmIsTheLeastShadowOfFourMoments) {
  raster::RasterOptions options = technique_options(Technique::msm);
  options.map.filter.light_bleeding_reduction = 0.0;
  options.map.filter.moment_bias =
      1e-3;  // large, so that the comparison is one of formulas and not of rounding
  compare(options, 0.03,
          moment_reference(
              [](double share) {
                const double z = 2.0 * share - 1.0;
                return BlurredFace::Value{z, z * z, z * z * z, z * z * z * z};
              },
              [](BlurredFace::Value m, double x) {
                const BlurredFace::Value safe{0.0, 0.375, 0.0, 0.375};
                for (std::size_t k = 0; k < 4; ++k) m[k] = m[k] * (1.0 - 1e-3) + 1e-3 * safe[k];
                return std::clamp(1.0 - judge::least_share_before(m, 2.0 * x - 1.0), 0.0, 1.0);
              }));
}

INSTANTIATE_TEST_SUITE_P(Lights, Filter,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

}  // namespace
}  // namespace gnomon::test
