#include "compare/ladder/moments.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"

namespace gnomon::compare {
namespace {

using raster::CapturedMoments;
using raster::Technique;
using Averages = std::array<double, 4>;

/// Of the square of a float that four operations made.
constexpr double square_rounding = 0x1p-22;

/// The warps of evsm (Lauritzen and McCool 2008), of x as [-1, 1].
double positive_warp(const CapturedMoments& moments, double x) {
  return std::exp(moments.filter.evsm_positive_exponent * (2.0 * x - 1.0));
}
double negative_warp(const CapturedMoments& moments, double x) {
  return -std::exp(-moments.filter.evsm_negative_exponent * (2.0 * x - 1.0));
}
double unwarped(const CapturedMoments& moments, double warped) {
  return 0.5 * (1.0 + std::log(std::max(warped, 1e-300)) / moments.filter.evsm_positive_exponent);
}

/// The variance floor is one of depth: a warp's slope scales it.
double evsm_light(const CapturedMoments& moments, const Averages& a, double x) {
  const auto& filter = moments.filter;
  const auto bound = [&](double mean, double square, double warped, double exponent) {
    const double slope = exponent * warped;
    return chebyshev(mean, square, warped, moments.minimum_variance * slope * slope);
  };
  const double positive = bound(a[0], a[1], positive_warp(moments, x), filter.evsm_positive_exponent);
  if (filter.evsm_negative_exponent == 0.0) return positive;
  return std::min(positive, bound(a[2], a[3], negative_warp(moments, x), filter.evsm_negative_exponent));
}

/// Moments that rounding leaves to no distribution are mended by a share of one with half of it at either end.
double msm_light(const CapturedMoments& moments, Averages a, double x) {
  for (double& one : a) one += moments.filter.moment_bias * (0.5 - one);
  return 1.0 - least_share_before(a, x);
}

/// Stored numbers and depths along forward of one texel, or of a place between texels.
struct Numbers {
  const raster::CapturedTest& test;
  const LightView& view;
  int face;
  double row, along;  ///< a texel's middle; depth along forward of 1 along its ray

  Numbers(const raster::LightRecord& record, raytrace::TexelKey key)
      : test(*record.captured->test), view(record.map.view), face(key.face()), row(key.row() + 0.5) {
    const Ray ray = texel_ray(view, face, key.column() + 0.5, row);
    along = glm::dot(ray.direction, view.face(face).forward);
  }
  double depth_of(double x) const {
    using Stores = raster::CapturedTest::Stores;
    if (test.stores == Stores::depths) return depth_from_stored(view, face, row, x);
    const double world = test.moments.range.x + x * (test.moments.range.y - test.moments.range.x);
    return test.stores == Stores::distances ? world * along : world;
  }
  /// Of the map's near and far depths.
  Interval ends() const {
    using Stores = raster::CapturedTest::Stores;
    if (test.stores == Stores::depths) return {0.0, 1.0};
    const Vec2& range = test.moments.range;
    const double per_depth = test.stores == Stores::distances ? 1.0 / along : 1.0;
    const auto number = [&](double depth) { return (depth * per_depth - range.x) / (range.y - range.x); };
    return {number(view.face(face).near_depth), number(view.face(face).far_depth)};
  }
};

/// The numbers between which one lies that has this share of what was averaged.
Interval averaged_numbers(const CapturedMoments& moments, const Averages& a) {
  const double share = moments.own_share, spread = std::sqrt((1.0 - share) / share);
  const auto reach = [&] { return spread * std::sqrt(std::max(a[1] - a[0] * a[0], square_rounding * a[1])); };
  switch (moments.technique) {
    case Technique::esm:
      return {-infinity, std::log(std::max(a[0] / share, 1e-300)) / moments.filter.esm_exponent};
    case Technique::evsm: {
      const double low = a[0] - reach();
      return {low > 0.0 ? unwarped(moments, low) : -infinity, unwarped(moments, a[0] + reach())};
    }
    default:
      return {a[0] - reach(), a[0] + reach()};
  }
}

Averages averages_of(const CapturedMoments::Texel& texel) {
  return {texel[0], texel[1], texel[2], texel[3]};
}

}  // namespace

double chebyshev(double mean, double square, double x, double least_variance) {
  if (x <= mean) return 1.0;
  const double variance = std::max({square - mean * mean, square * square_rounding, least_variance});
  return variance / (variance + (x - mean) * (x - mean));
}

double least_share_before(const Averages& b, double x) {
  // Points z are roots of a quadratic orthogonal to what (z - x) times 1 and z integrate to.
  const double m0 = b[0] - x, m1 = b[1] - x * b[0], m2 = b[2] - x * b[1], m3 = b[3] - x * b[2];
  // p + q z + z^2 with moments against (z - x): [m0 m1; m1 m2] (p, q) = -(m2, m3)
  const double det = m0 * m2 - m1 * m1;
  // Of one point, or of two of which x is one, the other alone may lie before it.
  if (std::abs(det) <= 1e-15 * (std::abs(m0 * m2) + m1 * m1)) {
    const double other = m0 != 0.0 ? m1 / m0 : x;
    return other < x ? m0 / (other - x) : 0.0;
  }
  const double p = (-m2 * m2 + m1 * m3) / det, q = (-m0 * m3 + m1 * m2) / det;
  const double root = std::sqrt(std::max(0.25 * q * q - p, 0.0));
  const double low = -0.5 * q - root, high = -0.5 * q + root;
  const auto weight = [&](double at, double other1, double other2) {
    return (b[1] - b[0] * (other1 + other2) + other1 * other2) / ((at - other1) * (at - other2));
  };
  double share = 0.0;
  if (low < x) share += weight(low, x, high);
  if (high < x) share += weight(high, x, low);
  return share;
}

double light_of_moments(const CapturedMoments& moments, const Averages& a, double x) {
  double light = 1.0;
  switch (moments.technique) {
    case Technique::esm:
      return std::min(1.0, a[0] * std::exp(-moments.filter.esm_exponent * x));
    case Technique::evsm:
      light = evsm_light(moments, a, x);
      break;
    case Technique::msm:
      light = msm_light(moments, a, x);
      break;
    default:
      light = chebyshev(a[0], a[1], x, moments.minimum_variance);
  }
  // Lauritzen 2007, GPU Gems 3, section 8.4.3.
  const double reduction = moments.filter.light_bleeding_reduction;
  return std::clamp((light - reduction) / (1.0 - reduction), 0.0, 1.0);
}

double mean_of_moments(const CapturedMoments& moments, const Averages& a) {
  if (moments.technique == Technique::esm)
    return std::log(std::max(a[0], 1e-300)) / moments.filter.esm_exponent;
  return moments.technique == Technique::evsm ? unwarped(moments, a[0]) : a[0];
}

std::array<double, 4> moments_between(const raster::LightRecord& record, const TexelCoordinate& at) {
  const CapturedMoments& moments = record.captured->test->moments;
  Averages read{};
  for (const WeighedTexel& near : texels_between(record, at))
    for (std::size_t k = 0; k < read.size(); ++k) read[k] += near.weight * moments.texels[near.index][k];
  return read;
}

std::optional<double> caster_of_moments(const raster::LightRecord& record, const BiasedLookup& lookup) {
  constexpr int halvings = 48;
  const CapturedMoments& moments = record.captured->test->moments;
  const Averages read = moments_between(record, lookup.at);
  const Numbers numbers(record, lookup.key);
  Interval between = numbers.ends();
  const auto has_half = [&](double x) { return light_of_moments(moments, read, x) >= 0.5; };
  if (has_half(between.max)) return std::nullopt;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (between.min + between.max);
    (has_half(middle) ? between.min : between.max) = middle;
  }
  return numbers.depth_of(between.min);
}

Interval averaged_depths(const raster::LightRecord& record, raytrace::TexelKey key) {
  const CapturedMoments& moments = record.captured->test->moments;
  const std::size_t index = record.map.texel_index(key.face(), key.column(), key.row());
  const Interval numbers = averaged_numbers(moments, averages_of(moments.texels[index]));
  const Numbers texel(record, key);
  const auto depth = [&](double x) {
    const Interval ends = texel.ends();
    return texel.depth_of(std::clamp(x, ends.min, ends.max));
  };
  return {depth(numbers.min), depth(numbers.max)};
}

}  // namespace gnomon::compare
