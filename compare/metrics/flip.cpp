// Every filter of FLIP is a Gaussian, a derivative of one, or a sum of two, and so separates into rows and
// columns. Pictures are worked on in patches with a margin as wide as the filters reach, which stay in the
// cache, over all threads; image borders are extended by their edge pixels, as in the paper's own code. Where
// both pictures of a patch are equal nothing is to be computed: the error is 0.
#include "compare/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "compare/metrics/differing.h"
#include "compare/metrics/weighted_rows.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

// Kernels hold 2 radius + 1 weights.
using Kernel = std::vector<float>;

int radius_of(const Kernel& kernel) {
  return static_cast<int>(kernel.size() / 2);
}

/// A patch's numbers, row by row.
struct FloatPlane {
  int width = 0, height = 0;
  std::vector<float> data;
  void reset(int w, int h) {
    width = w, height = h;
    data.assign(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0f);
  }
  float* row(int y) { return data.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const float* row(int y) const { return const_cast<FloatPlane*>(this)->row(y); }
};

/// The source filtered along rows, without its margin to the left and right.
void filter_rows(const FloatPlane& source, int margin, const Kernel& kernel, FloatPlane& target) {
  thread_local std::vector<const float*> shifted;
  target.reset(source.width - 2 * margin, source.height);
  for (int y = 0; y < source.height; ++y) {
    shifted.clear();
    const float* first = source.row(y) + margin - radius_of(kernel);
    for (std::size_t k = 0; k < kernel.size(); ++k) shifted.push_back(first + k);
    add_weighted_rows(shifted, kernel, target.row(y), target.width);
  }
}

/// target += the source filtered along columns, without its margin above and below.
void add_filtered_columns(const FloatPlane& source, int margin, const Kernel& kernel, FloatPlane& target) {
  thread_local std::vector<const float*> rows;
  for (int y = 0; y < target.height; ++y) {
    rows.clear();
    const int first = y + margin - radius_of(kernel);
    for (int k = 0; k < static_cast<int>(kernel.size()); ++k) rows.push_back(source.row(first + k));
    add_weighted_rows(rows, kernel, target.row(y), target.width);
  }
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

/// One Gaussian of a sensitivity; the columns' weights hold its share.
struct Blur {
  Kernel rows, columns;
};

std::vector<Blur> blurs_of(const Sensitivity& s, double ppd) {
  const int radius = sensitivity_radius(ppd);
  const std::array<double, 2> a{s.a1, s.a2}, b{s.b1, s.b2};
  std::array<Kernel, 2> kernels;
  std::array<double, 2> share{};
  for (std::size_t i = 0; i < 2; ++i) {
    double sum = 0.0;
    kernels[i] = gaussian(radius, pi * pi / (b[i] * ppd * ppd), sum);
    share[i] = a[i] * std::sqrt(pi / b[i]) * sum * sum;
  }
  std::vector<Blur> blurs;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!(share[i] > 0.0)) continue;
    const auto scale = static_cast<float>(share[i] / (share[0] + share[1]));
    Kernel columns = kernels[i];
    for (float& weight : columns) weight *= scale;
    blurs.push_back({std::move(kernels[i]), std::move(columns)});
  }
  return blurs;
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

/// All filters for one viewing distance.
struct Filters {
  explicit Filters(double ppd)
      : y(blurs_of(achromatic, ppd)),
        cx(blurs_of(red_green, ppd)),
        cz(blurs_of(blue_yellow, ppd)),
        features(feature_kernels(ppd)),
        margin(std::max(sensitivity_radius(ppd), radius_of(features.smooth))) {}

  std::vector<Blur> y, cx, cz;
  FeatureKernels features;
  int margin;
};

// --- one patch of one image ---

struct Patch {
  int x0, y0, width, height;  // without the margin
};

/// What is made of a patch; kept from patch to patch for its memory.
struct Perceived {
  FloatPlane opponent_y, opponent_cx, opponent_cz, luminance;              // with the margin
  FloatPlane y, cx, cz, edges_x, edges_y, points_x, points_y, along_rows;  // without
  std::vector<Vec3f> colour;         // Hunt-adjusted CIELAB after the eye's blur
  std::vector<float> edges, points;  // strength of features in luminance
};

/// pixel(index, place) for a patch with its margin: of each place the index of the image's nearest pixel.
template <class Pixel>
void for_each_pixel(const ImageSize& size, const Patch& patch, int margin, const Pixel& pixel) {
  std::size_t place = 0;
  for (int y = patch.y0 - margin; y < patch.y0 + patch.height + margin; ++y) {
    const std::size_t row =
        static_cast<std::size_t>(std::clamp(y, 0, size.height - 1)) * static_cast<std::size_t>(size.width);
    for (int x = patch.x0 - margin; x < patch.x0 + patch.width + margin; ++x)
      pixel(row + static_cast<std::size_t>(std::clamp(x, 0, size.width - 1)), place++);
  }
}

/// linear(index): the pixel's linear RGB.
template <class Linear>
void opponent_planes(const ImageSize& size, const Patch& patch, int margin, const Linear& linear,
                     Perceived& p) {
  for (FloatPlane* plane : {&p.opponent_y, &p.opponent_cx, &p.opponent_cz, &p.luminance})
    plane->reset(patch.width + 2 * margin, patch.height + 2 * margin);
  static const glm::mat3 xyz = relative_xyz_from_rgb();
  for_each_pixel(size, patch, margin, [&](std::size_t i, std::size_t place) {
    const Vec3f v = xyz * glm::clamp(linear(i), 0.0f, 1.0f), c = ycxcz_from_xyz(v);
    p.opponent_y.data[place] = c.x;
    p.opponent_cx.data[place] = c.y;
    p.opponent_cz.data[place] = c.z;
    p.luminance.data[place] = v.y;
  });
}

void blur(const FloatPlane& source, int margin, const std::vector<Blur>& blurs, FloatPlane& along_rows,
          FloatPlane& target) {
  target.reset(source.width - 2 * margin, source.height - 2 * margin);
  for (const Blur& b : blurs) {
    filter_rows(source, margin, b.rows, along_rows);
    add_filtered_columns(along_rows, margin, b.columns, target);
  }
}

void perceive_colour(const Filters& filters, Perceived& p) {
  blur(p.opponent_y, filters.margin, filters.y, p.along_rows, p.y);
  blur(p.opponent_cx, filters.margin, filters.cx, p.along_rows, p.cx);
  blur(p.opponent_cz, filters.margin, filters.cz, p.along_rows, p.cz);
  static const glm::mat3 xyz = relative_xyz_from_rgb(), rgb = glm::mat3(glm::inverse(Mat3(xyz)));
  p.colour.resize(p.y.data.size());
  Vec3f last(0.0f), colour(0.0f);  // most pixels are as the one before
  for (std::size_t i = 0; i < p.colour.size(); ++i) {
    const Vec3f seen(p.y.data[i], p.cx.data[i], p.cz.data[i]);
    if (i == 0 || seen != last) {
      colour = hunt_lab_from_xyz(xyz * glm::clamp(rgb * xyz_from_ycxcz(seen), 0.0f, 1.0f));
      last = seen;
    }
    p.colour[i] = colour;
  }
}

void lengths(const FloatPlane& x, const FloatPlane& y, std::vector<float>& out) {
  out.resize(x.data.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::sqrt(x.data[i] * x.data[i] + y.data[i] * y.data[i]);
}

void perceive_features(const Filters& filters, Perceived& p) {
  const FeatureKernels& k = filters.features;
  const auto columns = [&](const Kernel& kernel, FloatPlane& target) {
    target.reset(p.y.width, p.y.height);
    add_filtered_columns(p.along_rows, filters.margin, kernel, target);
  };
  filter_rows(p.luminance, filters.margin, k.edge, p.along_rows);
  columns(k.smooth, p.edges_x);
  filter_rows(p.luminance, filters.margin, k.point, p.along_rows);
  columns(k.smooth, p.points_x);
  filter_rows(p.luminance, filters.margin, k.smooth, p.along_rows);
  columns(k.edge, p.edges_y), columns(k.point, p.points_y);
  lengths(p.edges_x, p.edges_y, p.edges), lengths(p.points_x, p.points_y, p.points);
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

/// Linear RGB of a pixel.
struct Colours {
  const Vec3f* data;
  Vec3f operator()(std::size_t pixel) const { return data[pixel]; }
};
struct Greys {
  const float* data;
  Vec3f operator()(std::size_t pixel) const { return Vec3f(data[pixel]); }
};

constexpr int patch_width = 256, patch_height = 64;

template <class Linear>
void flip_patch(const Filters& filters, const Patch& patch, const Linear& reference, const Linear& test,
                Image<float>& error) {
  thread_local Perceived a, b;
  for (Perceived* p : {&a, &b}) {
    opponent_planes(error.size, patch, filters.margin, p == &a ? reference : test, *p);
    perceive_colour(filters, *p);
    perceive_features(filters, *p);
  }
  for_each_pixel(error.size, patch, 0, [&](std::size_t i, std::size_t place) {
    if (a.colour[place] == b.colour[place] && a.edges[place] == b.edges[place] &&
        a.points[place] == b.points[place])
      return;  // the error is 0
    const float colour = colour_difference(a.colour[place], b.colour[place]);
    const float feature =
        feature_difference(a.edges[place], b.edges[place], a.points[place], b.points[place]);
    error.data[i] = std::pow(colour, 1.0f - feature);  // section 4.3
  });
}

template <class Linear>
Image<float> flip_of(const ImageSize& size, const Linear& reference, const Linear& test, double ppd) {
  const Filters filters(ppd);
  Image<float> error(size);
  const Differing differing(size, reference, test);
  const int margin = filters.margin;
  parallel_for((size.height + patch_height - 1) / patch_height, [&](int strip) {
    const int y0 = strip * patch_height, y1 = std::min(y0 + patch_height, size.height);
    differing.for_each_range(y0 - margin, y1 + margin, margin, margin, [&](const ColumnRange& range) {
      for (int x0 = range.first; x0 < range.end; x0 += patch_width)
        flip_patch(filters, {x0, y0, std::min(patch_width, range.end - x0), y1 - y0}, reference, test, error);
    });
  });
  return error;
}

}  // namespace

Image<float> flip_error(const ColorImage& reference_linear, const ColorImage& test_linear,
                        double pixels_per_degree) {
  assert(reference_linear.size == test_linear.size);
  return flip_of(reference_linear.size, Colours{reference_linear.data.data()},
                 Colours{test_linear.data.data()}, pixels_per_degree);
}

Image<float> flip_error(const Image<float>& reference_grey, const Image<float>& test_grey,
                        double pixels_per_degree) {
  assert(reference_grey.size == test_grey.size);
  return flip_of(reference_grey.size, Greys{reference_grey.data.data()}, Greys{test_grey.data.data()},
                 pixels_per_degree);
}

double mean_flip(const ColorImage& reference_linear, const ColorImage& test_linear,
                 double pixels_per_degree) {
  return mean_flip(flip_error(reference_linear, test_linear, pixels_per_degree));
}

double mean_flip(const Image<float>& error) {
  std::vector<double> rows(static_cast<std::size_t>(error.size.height), 0.0);
  const auto width = static_cast<std::size_t>(error.size.width);
  parallel_for(rows.size(), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) rows[y] += static_cast<double>(error.data[i]);
  });
  const double sum = std::accumulate(rows.begin(), rows.end(), 0.0);
  return error.data.empty() ? 0.0 : sum / static_cast<double>(error.data.size());
}

}  // namespace gnomon::compare
