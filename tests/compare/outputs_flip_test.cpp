// FLIP against a second implementation written straight from the paper: whole two-dimensional kernels, double
// precision, no separation. Largest difference allowed: 2e-3 per pixel. Where both images agree nearly but
// not quite, the final power with an exponent down to zero magnifies float rounding of 1e-6 by about
// (1e-6)^0.5.
#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "compare/measure/shaded.h"
#include "compare/measure/subpixels.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/weighted_rows.h"

namespace gnomon::compare {
namespace {

// --- the direct implementation ---

struct Direct {
  int width, height;
  double ppd;
  using Field = std::vector<Vec3>;

  static Vec3 xyz(const Vec3& c) {
    return {(10135552 * c.x + 8788810 * c.y + 4435075 * c.z) / 24577794.0,
            (2613072 * c.x + 8788810 * c.y + 887015 * c.z) / 12288897.0,
            (1425312 * c.x + 8788810 * c.y + 70074185 * c.z) / 73733382.0};
  }
  static Vec3 relative(const Vec3& c) { return xyz(c) / xyz(Vec3(1.0)); }
  static Vec3 rgb(const Vec3& rel) {
    const Vec3 v = rel * xyz(Vec3(1.0));
    const Mat3 m(xyz(Vec3(1, 0, 0)), xyz(Vec3(0, 1, 0)), xyz(Vec3(0, 0, 1)));
    return glm::inverse(m) * v;
  }
  static Vec3 lab(const Vec3& v) {
    const auto f = [](double t) {
      return t > 216.0 / 24389.0 ? std::pow(t, 1.0 / 3.0) : t * 841.0 / 108.0 + 4.0 / 29.0;
    };
    const double l = 116.0 * f(v.y) - 16.0;
    return {l, 0.01 * l * 500.0 * (f(v.x) - f(v.y)), 0.01 * l * 200.0 * (f(v.y) - f(v.z))};
  }
  static double hyab(const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
  }
  const Vec3& clamped(const Field& f, int x, int y) const {
    const int at = std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1);
    return f[static_cast<std::size_t>(at)];
  }

  Vec3 blurred(const Field& opponent, int x, int y) const {
    const int r = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto g = [](double a, double b, double z) {
      return a * std::sqrt(pi / b) * std::exp(-pi * pi * z / b);
    };
    Vec3 sum(0.0), weights(0.0);
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) {
        const double z = (i * i + j * j) / (ppd * ppd);
        const Vec3 w(g(1, 0.0047, z), g(1, 0.0053, z), g(34.1, 0.04, z) + g(13.5, 0.025, z));
        sum += w * clamped(opponent, x + i, y + j);
        weights += w;
      }
    return sum / weights;
  }

  // The strength of edges (or points) at a pixel: the length of the two directional responses.
  double feature(const Field& opponent, int x, int y, bool point) const {
    const double sd = 0.5 * 0.082 * ppd;
    const int r = static_cast<int>(std::ceil(3 * sd));
    const auto weight = [&](int along, int across) {
      const double g = std::exp(-(along * along + across * across) / (2 * sd * sd));
      return point ? (along * along / (sd * sd) - 1) * g : -along * g;
    };
    double positive = 0, negative = 0, px = 0, nx = 0, py = 0, ny = 0;
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) {
        const double luminance = (clamped(opponent, x + i, y + j).x + 16.0) / 116.0, wx = weight(i, j),
                     wy = weight(j, i);
        (wx > 0 ? positive : negative) += std::abs(wx);
        (wx > 0 ? px : nx) += wx * luminance;
        (wy > 0 ? py : ny) += wy * luminance;
      }
    return std::hypot(px / positive + nx / negative, py / positive + ny / negative);
  }

  Field opponent(const ColorImage& image) const {
    Field f;
    for (const Vec3f& c : image.data) {
      const Vec3 v = relative(Vec3(c));
      f.emplace_back(116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z));
    }
    return f;
  }

  Vec3 seen(const Field& f, int x, int y) const {
    const Vec3 o = blurred(f, x, y);
    const double v = (o.x + 16) / 116;
    return lab(relative(glm::clamp(rgb({v + o.y / 500, v, v - o.z / 200}), 0.0, 1.0)));
  }

  double error(const Field& a, const Field& b, int x, int y) const {
    const double largest = std::pow(hyab(lab(relative({0, 1, 0})), lab(relative({0, 0, 1}))), 0.7);
    const double e = std::pow(hyab(seen(a, x, y), seen(b, x, y)), 0.7);
    const double colour =
        e < 0.4 * largest ? 0.95 / (0.4 * largest) * e : 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
    const double features = std::max(std::abs(feature(a, x, y, false) - feature(b, x, y, false)),
                                     std::abs(feature(a, x, y, true) - feature(b, x, y, true)));
    return std::pow(colour, 1 - std::min(1.0, std::sqrt(features / std::sqrt(2.0))));
  }
};

ColorImage flat(Vec3f colour, ImageSize size = {40, 30}) {
  return ColorImage(size, colour);
}

void expect_same_as_direct(const ColorImage& a, const ColorImage& b, double ppd) {
  const Direct direct{a.size.width, a.size.height, ppd};
  const auto fa = direct.opponent(a), fb = direct.opponent(b);
  const Image<float> fast = flip_error(a, b, ppd);
  double worst = 0.0, sum = 0.0;
  for (int y = 0; y < a.size.height; ++y)
    for (int x = 0; x < a.size.width; ++x) {
      const double difference = std::abs(direct.error(fa, fb, x, y) - static_cast<double>(fast.at(x, y)));
      worst = std::max(worst, difference);
      sum += difference;
    }
  EXPECT_LT(worst, 2e-3);
  EXPECT_LT(sum / static_cast<double>(a.size.pixels()), 2e-5);
}

TEST(Flip, EqualsTheDirectImplementationOnNoise) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  ColorImage a(ImageSize{37, 29}), b(a.size);
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    a.data[i] = {value(random), value(random), value(random)};
    b.data[i] = i % 3 == 0 ? a.data[i] : Vec3f{value(random), value(random), value(random)};
  }
  expect_same_as_direct(a, b, flip_pixels_per_degree);
  expect_same_as_direct(a, b, 30.0);
}

TEST(Flip, EqualsTheDirectImplementationOnShadowEdges) {
  ColorImage a(ImageSize{48, 40}), b(a.size);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) {
      a.at(x, y) = Vec3f(x + y / 2 < 30 ? 1.0f : 0.0f);
      b.at(x, y) = Vec3f((x / 4) * 4 + (y / 4) * 2 < 30 ? 1.0f : 0.0f);
    }
  expect_same_as_direct(a, b, flip_pixels_per_degree);
}

// Only what lies within the filters' reach of a difference is worked out, which is asked of blocks of pixels.
TEST(Flip, EqualsTheDirectImplementationWherePicturesDifferHereAndThere) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  ColorImage a(ImageSize{131, 97});
  for (Vec3f& colour : a.data) colour = {value(random), value(random), value(random)};
  ColorImage b = a;
  for (const auto& [x, y] : {std::pair{0, 96}, {31, 20}, {32, 20}, {100, 64}, {130, 0}})
    b.at(x, y) = Vec3f(1.0f) - b.at(x, y);
  expect_same_as_direct(a, b, flip_pixels_per_degree);
}

// The error depends on nothing beyond the filters' reach, whichever way a picture is cut into patches: a part
// of it, with a margin, has the same bits. Both pictures are equal up to a little beyond the first patch.
TEST(Flip, APartHasTheErrorsOfTheWhole) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  Image<float> a(ImageSize{611, 157}), b(a.size);
  for (int y = 0; y < a.size.height; ++y)
    for (int x = 0; x < a.size.width; ++x)
      a.at(x, y) = value(random), b.at(x, y) = x < 257 ? a.at(x, y) : value(random);
  const int left = 151, top = 37, margin = 11;
  Image<float> part_a(ImageSize{313, 101}), part_b(part_a.size);
  for (int y = 0; y < part_a.size.height; ++y)
    for (int x = 0; x < part_a.size.width; ++x)
      part_a.at(x, y) = a.at(left + x, top + y), part_b.at(x, y) = b.at(left + x, top + y);
  const Image<float> whole = flip_error(a, b), part = flip_error(part_a, part_b);
  int above_zero = 0;
  for (int y = margin; y < part.size.height - margin; ++y)
    for (int x = margin; x < part.size.width - margin; ++x) {
      EXPECT_EQ(part.at(x, y), whole.at(left + x, top + y)) << x << " " << y;
      above_zero += part.at(x, y) > 0.0f ? 1 : 0;
    }
  EXPECT_GT(above_zero, 1000);
}

TEST(Flip, GreyIsAColour) {
  std::mt19937 random(13);
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  Image<float> a(ImageSize{70, 66}), b(a.size);
  ColorImage colour_a(a.size), colour_b(a.size);
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    a.data[i] = value(random), b.data[i] = value(random);
    colour_a.data[i] = Vec3f(a.data[i]), colour_b.data[i] = Vec3f(b.data[i]);
  }
  EXPECT_EQ(flip_error(a, b).data, flip_error(colour_a, colour_b).data);
}

TEST(Flip, IsZeroForEqualImages) {
  EXPECT_EQ(mean_flip(flat({0.3f, 0.5f, 0.1f}), flat({0.3f, 0.5f, 0.1f})), 0.0);
}

// Flat fields have no features, so the paper's colour formula alone is left:
// black to white has HyAB 100, and 100^0.7 lies 0.347 of the way from the knee to the largest difference.
TEST(Flip, BlackToWhiteIsTheClosedForm) {
  const double largest = std::pow(203.2827, 0.7), knee = 0.4 * largest;  // green to blue with the Hunt effect
  EXPECT_NEAR(mean_flip(flat(Vec3f(0.0f)), flat(Vec3f(1.0f))),
              0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee), 1e-4);
}

TEST(Flip, GreenToBlueIsTheLargestDifference) {
  EXPECT_NEAR(mean_flip(flat({0, 1, 0}), flat({0, 0, 1})), 1.0, 1e-5);
}

TEST(Flip, GrowsWithTheDifferenceAndIsSymmetric) {
  double last = 0.0;
  for (const float grey : {0.55f, 0.6f, 0.8f, 1.0f}) {
    const double now = mean_flip(flat(Vec3f(0.5f)), flat(Vec3f(grey)));
    EXPECT_GT(now, last);
    EXPECT_NEAR(now, mean_flip(flat(Vec3f(grey)), flat(Vec3f(0.5f))), 1e-6);
    last = now;
  }
}

TEST(Flip, ClipsToTheDisplayableRange) {
  EXPECT_EQ(mean_flip(flat(Vec3f(1.0f)), flat(Vec3f(3.0f))), 0.0);
}

TEST(Flip, HandlesImagesSmallerThanItsFilters) {
  const double one = mean_flip(flat(Vec3f(0.0f), {1, 1}), flat(Vec3f(1.0f), {1, 1}));
  EXPECT_NEAR(one, mean_flip(flat(Vec3f(0.0f)), flat(Vec3f(1.0f))), 1e-5);
  EXPECT_EQ(mean_flip(flat(Vec3f(0.0f), {0, 0}), flat(Vec3f(1.0f), {0, 0})), 0.0);
}

// The filters' inner loop against the plain one, to the last bit, for widths that fill vectors and do not.
TEST(WeightedRows, AreThePlainSum) {
  const std::vector<float> weights{0.011f, 0.3f, -0.7f, 0.25f, 1e-3f};
  for (const int width : {1, 7, 16, 64, 65, 131}) {
    std::vector<std::vector<float>> rows;
    std::vector<const float*> starts;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      auto& row = rows.emplace_back();
      for (int x = 0; x < width; ++x)
        row.push_back(std::sin(static_cast<float>(x) + 3.7f * static_cast<float>(k)));
    }
    for (const auto& row : rows) starts.push_back(row.data());
    std::vector<float> sums(static_cast<std::size_t>(width), 0.5f), plain = sums;
    add_weighted_rows(starts, weights, sums.data(), width);
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::size_t x = 0; x < plain.size(); ++x) plain[x] += weights[k] * rows[k][x];
    EXPECT_EQ(sums, plain) << width;
  }
}

TEST(Shaded, IsTheMeanOfWhatAScreenShows) {
  compare::Comparison c;
  c.exposure = 2.0;
  c.raster.color = c.raytraced.color = ColorImage({4, 4}, Vec3f(0.25f));
  compare::LightComparison& light = c.lights.emplace_back();
  light.labels = Image<compare::Label>({4, 4}, compare::Label::right);
  EXPECT_EQ(compare::shaded_error(c)->mean_absolute, 0.0);
  c.raster.color.data[0] = Vec3f(9.0f, 0.0f, 0.25f);  // 1, 0 and as before on the screen
  c.raster.color.data[1] = Vec3f(0.25f + 0.0005f);    // less than half a step of eight bits
  c.raster.color.data[2] = Vec3f(0.0f);               // on a silhouette
  light.labels.data[2] = compare::Label::silhouette;
  const double middle = 1.055 * std::pow(0.5, 1.0 / 2.4) - 0.055;
  const auto shaded = compare::shaded_error(c);
  ASSERT_TRUE(shaded);
  EXPECT_NEAR(shaded->mean_absolute, ((1.0 - middle) + middle) / 3.0 / 15.0, 1e-9);
  EXPECT_GT(shaded->flip, 0.0);
  c.plan.entries[static_cast<std::size_t>(Effect::reflection)].simulated = true;
  EXPECT_FALSE(compare::shaded_error(c));
}

TEST(Subpixel, IsTheMeanOverThePlacesOfEachPixel) {
  compare::SubpixelSums sums({2, 1}, 2, 1);
  compare::Climb rows;  // the upper row of places, then the lower one
  for (Image<float>& rung : rows.rungs) rung = Image<float>({4, 1}, 1.0f);
  rows.labels = Image<compare::Label>({4, 1}, compare::Label::right);
  rows.rungs.back().data = {0.0f, 1.0f, 1.0f, 1.0f};
  sums.add(0, 0, rows);
  rows.rungs.back().data = {0.0f, 0.0f, 0.5f, 0.0f};
  rows.labels.data = {compare::Label::acne, compare::Label::acne, compare::Label::silhouette,
                      compare::Label::background};
  sums.add(0, 1, rows);
  const compare::SubpixelFigures of = sums.figures(0);
  EXPECT_EQ(of.places, 4);
  EXPECT_EQ(of.pixels, 2u);
  EXPECT_DOUBLE_EQ(of.mean_absolute, (0.75 + 0.0) / 2.0);
  EXPECT_DOUBLE_EQ(of.wrong_fraction, 0.5);
  EXPECT_DOUBLE_EQ(of.unknown, 1.0 / 7.0);
}

}  // namespace
}  // namespace gnomon::compare
