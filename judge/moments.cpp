#include "judge/moments.h"

#include <algorithm>
#include <cmath>

namespace gnomon::judge {
namespace {

using raster::Technique;

/// Of the square of a float that four operations made.
constexpr double square_rounding = 0x1p-22;

/// The warps of evsm (Lauritzen and McCool 2008), of x as [-1, 1].
double positive_warp(const MomentFormula& moments, double x) {
  return std::exp(moments.filter.evsm_positive_exponent * (2.0 * x - 1.0));
}
double negative_warp(const MomentFormula& moments, double x) {
  return -std::exp(-moments.filter.evsm_negative_exponent * (2.0 * x - 1.0));
}
double unwarped(const MomentFormula& moments, double warped) {
  return 0.5 * (1.0 + std::log(std::max(warped, 1e-300)) / moments.filter.evsm_positive_exponent);
}

/// The variance floor is one of depth: a warp's slope scales it.
double evsm_light(const MomentFormula& moments, const Averages& a, double x) {
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
double msm_light(const MomentFormula& moments, Averages a, double x) {
  for (double& one : a) one += moments.filter.moment_bias * (0.5 - one);
  return 1.0 - least_share_before(a, x);
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

double MomentFormula::light(const Averages& a, double x) const {
  double out = 1.0;
  switch (technique) {
    case Technique::esm:
      return std::min(1.0, a[0] * std::exp(-filter.esm_exponent * x));
    case Technique::evsm:
      out = evsm_light(*this, a, x);
      break;
    case Technique::msm:
      out = msm_light(*this, a, x);
      break;
    default:
      out = chebyshev(a[0], a[1], x, minimum_variance);
  }
  // Lauritzen 2007, GPU Gems 3, section 8.4.3.
  const double reduction = filter.light_bleeding_reduction;
  return std::clamp((out - reduction) / (1.0 - reduction), 0.0, 1.0);
}

double MomentFormula::mean(const Averages& a) const {
  if (technique == Technique::esm) return std::log(std::max(a[0], 1e-300)) / filter.esm_exponent;
  return technique == Technique::evsm ? unwarped(*this, a[0]) : a[0];
}

Interval MomentFormula::own_numbers(const Averages& a) const {
  const double share = own_share, spread = std::sqrt((1.0 - share) / share);
  const auto reach = [&] { return spread * std::sqrt(std::max(a[1] - a[0] * a[0], square_rounding * a[1])); };
  switch (technique) {
    case Technique::esm:
      return {-infinity, std::log(std::max(a[0] / share, 1e-300)) / filter.esm_exponent};
    case Technique::evsm: {
      const double low = a[0] - reach();
      return {low > 0.0 ? unwarped(*this, low) : -infinity, unwarped(*this, a[0] + reach())};
    }
    default:
      return {a[0] - reach(), a[0] + reach()};
  }
}

}  // namespace gnomon::judge
