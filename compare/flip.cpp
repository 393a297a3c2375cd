// Every filter of FLIP is a Gaussian, a derivative of one, or a sum of two, and so separates into rows and
// columns; planes of float, rows in parallel. Image borders are extended by their edge pixels, as in the
// paper's own code.
#include "compare/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "compare/weighted_rows.h"

namespace gnomon::compare {
namespace {

using Plane = Image<float>;

// Kernels hold 2 radius + 1 weights.
using Kernel = std::vector<float>;

int radius_of(const Kernel& kernel) {
  return static_cast<int>(kernel.size() / 2);
}

Plane filter_rows(const Plane& source, const Kernel& kernel) {
  Plane target(source.size);
  const int width = source.size.width, r = radius_of(kernel);
  tbb::parallel_for(0, source.size.height, [&](int y) {
    thread_local std::vector<float> padded;
    thread_local std::vector<const float*> shifted;
    padded.resize(static_cast<std::size_t>(width + 2 * r));
    const float* row = &source.at(0, y);
    std::fill_n(padded.begin(), r, row[0]);
    std::copy_n(row, width, padded.begin() + r);
    std::fill_n(padded.begin() + r + width, r, row[width - 1]);
    shifted.clear();
    for (std::size_t k = 0; k < kernel.size(); ++k) shifted.push_back(padded.data() + k);
    add_weighted_rows(shifted, kernel, &target.at(0, y), width);
  });
  return target;
}

// target += scale * (source filtered along columns).
void add_filtered_columns(Plane& target, const Plane& source, const Kernel& kernel, float scale) {
  const int height = source.size.height, r = radius_of(kernel);
  Kernel scaled = kernel;
  for (float& weight : scaled) weight *= scale;
  tbb::parallel_for(0, height, [&](int y) {
    thread_local std::vector<const float*> rows;
    rows.clear();
    for (int k = -r; k <= r; ++k) rows.push_back(&source.at(0, std::clamp(y + k, 0, height - 1)));
    add_weighted_rows(rows, scaled, &target.at(0, y), source.size.width);
  });
}

Plane filter_columns(const Plane& source, const Kernel& kernel) {
  Plane target(source.size);
  add_filtered_columns(target, source, kernel, 1.0f);
  return target;
}

// --- colour spaces (section 4.1; the matrix is the reference code's rational form of sRGB's primaries and
// D65) ------

const Mat3& xyz_from_rgb() {
  static const Mat3 matrix =
      glm::transpose(Mat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,
                          2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,
                          1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
  return matrix;
}

// XYZ relative to the white point, so that white is (1, 1, 1).
glm::mat3 relative_xyz_from_rgb() {
  const Vec3 white = xyz_from_rgb() * Vec3(1.0);
  Mat3 scale(0.0);
  for (int k = 0; k < 3; ++k) scale[k][k] = 1.0 / white[k];
  return glm::mat3(scale * xyz_from_rgb());
}

Vec3f ycxcz_from_xyz(const Vec3f& v) {
  return {116.0f * v.y - 16.0f, 500.0f * (v.x - v.y), 200.0f * (v.y - v.z)};
}

Vec3f xyz_from_ycxcz(const Vec3f& c) {
  const float y = (c.x + 16.0f) / 116.0f;
  return {y + c.y / 500.0f, y, y - c.z / 200.0f};
}

float lab_curve(float t) {
  constexpr float delta = 6.0f / 29.0f;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
}

// CIELAB with the Hunt effect: chroma fades with lightness (section 4.1.2, equation 6).
Vec3f hunt_lab_from_xyz(const Vec3f& v) {
  const Vec3f f(lab_curve(v.x), lab_curve(v.y), lab_curve(v.z));
  const float lightness = 116.0f * f.y - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (f.x - f.y), 0.01f * lightness * 200.0f * (f.y - f.z)};
}

// HyAB (Abasi et al. 2020; section 4.1.3).
float hyab(const Vec3f& a, const Vec3f& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- filters ---

// A contrast sensitivity function in the image domain: a sum of a_i sqrt(pi / b_i) exp(-pi^2 d^2 / b_i), d in
// degrees (section 4.1.1, table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1.0, 0.0047, 0.0, 1e-5}, red_green{1.0, 0.0053, 0.0, 1e-5},
    blue_yellow{34.1, 0.04, 13.5, 0.025};

int sensitivity_radius(double pixels_per_degree) {
  return static_cast<int>(std::ceil(3.0 * std::sqrt(blue_yellow.b1 / (2.0 * pi * pi)) * pixels_per_degree));
}

// exp(-x^2 scale), normalised to sum 1; `sum` is what it summed to before.
Kernel gaussian(int radius, double scale, double& sum) {
  std::vector<double> weights;
  sum = 0.0;
  for (int x = -radius; x <= radius; ++x)
    sum += weights.emplace_back(std::exp(-static_cast<double>(x * x) * scale));
  Kernel kernel;
  for (const double w : weights) kernel.push_back(static_cast<float>(w / sum));
  return kernel;
}

Plane sensitivity_filtered(const Plane& plane, const Sensitivity& s, double ppd) {
  const int radius = sensitivity_radius(ppd);
  const std::array<double, 2> a{s.a1, s.a2}, b{s.b1, s.b2};
  std::array<Kernel, 2> kernels;
  std::array<double, 2> share{};
  for (std::size_t i = 0; i < 2; ++i) {
    double sum = 0.0;
    kernels[i] = gaussian(radius, pi * pi / (b[i] * ppd * ppd), sum);
    share[i] = a[i] * std::sqrt(pi / b[i]) * sum * sum;
  }
  Plane out(plane.size);
  for (std::size_t i = 0; i < 2; ++i)
    if (share[i] > 0.0)
      add_filtered_columns(out, filter_rows(plane, kernels[i]), kernels[i],
                           static_cast<float>(share[i] / (share[0] + share[1])));
  return out;
}

// First and second derivative of a Gaussian whose width is that of the eye's feature detectors, w = 0.082
// degrees (section 4.2); positive and negative weights each sum to one.
struct FeatureKernels {
  Kernel smooth, edge, point;
};

Kernel balanced(const std::vector<double>& weights) {
  double positive = 0.0, negative = 0.0;
  for (const double w : weights) (w > 0.0 ? positive : negative) += std::abs(w);
  Kernel kernel;
  for (const double w : weights)
    kernel.push_back(static_cast<float>(w > 0.0 ? w / positive : w < 0.0 ? w / negative : 0.0));
  return kernel;
}

FeatureKernels feature_kernels(double ppd) {
  const double deviation = 0.5 * 0.082 * ppd, variance = deviation * deviation;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  double sum = 0.0;
  FeatureKernels kernels;
  kernels.smooth = gaussian(radius, 0.5 / variance, sum);
  std::vector<double> edge, point;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i, g = std::exp(-0.5 * x * x / variance);
    edge.push_back(-x * g);
    point.push_back((x * x / variance - 1.0) * g);
  }
  kernels.edge = balanced(edge);
  kernels.point = balanced(point);
  return kernels;
}

Plane length_of(Plane x, const Plane& y) {
  tbb::parallel_for(0, x.size.height, [&](int row) {
    for (int column = 0; column < x.size.width; ++column) {
      float& v = x.at(column, row);
      v = std::sqrt(v * v + y.at(column, row) * y.at(column, row));
    }
  });
  return x;
}

// --- one image ---

struct Perceived {
  Image<Vec3f> colour;  // Hunt-adjusted CIELAB after the eye's blur
  Plane edges, points;  // strength of features in luminance
};

struct Opponent {
  Plane y, cx, cz, luminance;
};

Opponent opponent_planes(const ColorImage& linear) {
  Opponent planes{Plane(linear.size), Plane(linear.size), Plane(linear.size), Plane(linear.size)};
  const glm::mat3 xyz = relative_xyz_from_rgb();
  tbb::parallel_for(0, linear.size.height, [&](int row) {
    for (int column = 0; column < linear.size.width; ++column) {
      const std::size_t i = linear.index(column, row);
      const Vec3f v = xyz * glm::clamp(linear.data[i], 0.0f, 1.0f), c = ycxcz_from_xyz(v);
      planes.y.data[i] = c.x;
      planes.cx.data[i] = c.y;
      planes.cz.data[i] = c.z;
      planes.luminance.data[i] = v.y;
    }
  });
  return planes;
}

Image<Vec3f> perceived_colour(const Opponent& planes, double ppd) {
  const Plane y = sensitivity_filtered(planes.y, achromatic, ppd);
  const Plane cx = sensitivity_filtered(planes.cx, red_green, ppd);
  const Plane cz = sensitivity_filtered(planes.cz, blue_yellow, ppd);
  const glm::mat3 xyz = relative_xyz_from_rgb(), rgb = glm::mat3(glm::inverse(Mat3(xyz)));
  Image<Vec3f> colour(y.size);
  tbb::parallel_for(0, y.size.height, [&](int row) {
    for (int column = 0; column < y.size.width; ++column) {
      const std::size_t i = y.index(column, row);
      const Vec3f shown = glm::clamp(rgb * xyz_from_ycxcz({y.data[i], cx.data[i], cz.data[i]}), 0.0f, 1.0f);
      colour.data[i] = hunt_lab_from_xyz(xyz * shown);
    }
  });
  return colour;
}

Perceived perceive(const ColorImage& linear, double ppd) {
  const Opponent planes = opponent_planes(linear);
  const FeatureKernels kernels = feature_kernels(ppd);
  const Plane smooth = filter_rows(planes.luminance, kernels.smooth);
  Perceived p;
  p.edges = length_of(filter_columns(filter_rows(planes.luminance, kernels.edge), kernels.smooth),
                      filter_columns(smooth, kernels.edge));
  p.points = length_of(filter_columns(filter_rows(planes.luminance, kernels.point), kernels.smooth),
                       filter_columns(smooth, kernels.point));
  p.colour = perceived_colour(planes, ppd);
  return p;
}

// --- the difference ---

constexpr float colour_exponent = 0.7f, feature_exponent = 0.5f;  // q_c, q_f

// Section 4.1.3: differences up to p_c of the largest possible fill [0, p_t], the rest [p_t, 1].
float colour_difference(const Vec3f& reference, const Vec3f& test) {
  static const float largest = [] {
    const glm::mat3 xyz = relative_xyz_from_rgb();
    const Vec3f green = hunt_lab_from_xyz(xyz * Vec3f(0, 1, 0)),
                blue = hunt_lab_from_xyz(xyz * Vec3f(0, 0, 1));
    return std::pow(hyab(green, blue), colour_exponent);
  }();
  constexpr float share = 0.4f, target = 0.95f;  // p_c, p_t
  const float error = std::pow(hyab(reference, test), colour_exponent), knee = share * largest;
  return error < knee ? target / knee * error : target + (error - knee) / (largest - knee) * (1.0f - target);
}

// Section 4.2.
float feature_difference(float edges_a, float edges_b, float points_a, float points_b) {
  const float largest = std::max(std::abs(edges_a - edges_b), std::abs(points_a - points_b));
  return std::min(std::pow(largest * (std::numbers::sqrt2_v<float> / 2.0f), feature_exponent), 1.0f);
}

}  // namespace

Image<float> flip_error(const ColorImage& reference_linear, const ColorImage& test_linear,
                        double pixels_per_degree) {
  assert(reference_linear.size == test_linear.size);
  const Perceived a = perceive(reference_linear, pixels_per_degree),
                  b = perceive(test_linear, pixels_per_degree);
  Image<float> error(reference_linear.size);
  tbb::parallel_for(0, error.size.height, [&](int y) {
    for (int x = 0; x < error.size.width; ++x) {
      const std::size_t i = error.index(x, y);
      const float colour = colour_difference(a.colour.data[i], b.colour.data[i]);
      const float feature =
          feature_difference(a.edges.data[i], b.edges.data[i], a.points.data[i], b.points.data[i]);
      error.data[i] = std::pow(colour, 1.0f - feature);  // section 4.3
    }
  });
  return error;
}

double mean_flip(const ColorImage& reference_linear, const ColorImage& test_linear,
                 double pixels_per_degree) {
  return mean_flip(flip_error(reference_linear, test_linear, pixels_per_degree));
}

double mean_flip(const Image<float>& error) {
  double sum = 0.0;
  for (const float e : error.data) sum += static_cast<double>(e);
  return error.data.empty() ? 0.0 : sum / static_cast<double>(error.data.size());
}

}  // namespace gnomon::compare
