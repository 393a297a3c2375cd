// SSIM against its formula, window by window, and where it is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "compare/metrics/ssim.h"

namespace gnomon::compare {
namespace {

Image<float> noise(ImageSize size, unsigned seed) {
  Image<float> image(size);
  std::mt19937 random(seed);
  for (float& value : image.data) value = static_cast<float>(random() % 1000) / 999.0f;
  return image;
}

// Equation 13 of the paper with a two-dimensional window, summed naively.
double one_window(const Image<float>& a, const Image<float>& b, int left, int top) {
  double weights = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 11; ++x) {
        const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
        const double p = a.at(left + x, top + y), q = b.at(left + x, top + y);
        if (pass == 0)
          weights += w, ma += w * p, mb += w * q;
        else
          va += w * (p - ma) * (p - ma), vb += w * (q - mb) * (q - mb), cov += w * (p - ma) * (q - mb);
      }
    if (pass == 0) ma /= weights, mb /= weights;
  }
  va /= weights, vb /= weights, cov /= weights;
  return (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
}

TEST(Ssim, IsTheFormulaAtEveryWindow) {
  const Image<float> a = noise({31, 17}, 1), b = noise({31, 17}, 2);
  const Image<float> map = ssim_map(a, b);
  ASSERT_EQ(map.size, (ImageSize{21, 7}));
  double sum = 0.0;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 21; ++x) {
      // Moments in one pass lose a few digits of double against the two-pass sum; the map is float.
      EXPECT_NEAR(map.at(x, y), one_window(a, b, x, y), 1e-6);
      sum += one_window(a, b, x, y);
    }
  EXPECT_NEAR(mean_ssim(a, b), sum / (21 * 7), 1e-6);
}

// Windows are worked out only where some pixel of theirs differs, which is asked of blocks of pixels.
TEST(Ssim, OfPicturesThatDifferHereAndThereIsTheFormulaToo) {
  const Image<float> a = noise({211, 45}, 4);
  Image<float> b = a;
  for (const auto& [x, y] : {std::pair{0, 0}, {15, 12}, {16, 12}, {90, 44}, {121, 30}, {210, 3}, {210, 44}})
    b.at(x, y) = 1.0f - b.at(x, y);
  const Image<float> map = ssim_map(a, b);
  int equal = 0;
  for (int y = 0; y < map.size.height; ++y)
    for (int x = 0; x < map.size.width; ++x) {
      ASSERT_NEAR(map.at(x, y), one_window(a, b, x, y), 1e-6) << x << " " << y;
      equal += map.at(x, y) == 1.0f ? 1 : 0;
    }
  EXPECT_GT(equal, 5000);
}

TEST(Ssim, KnownValues) {
  const Image<float> a = noise({20, 20}, 3);
  EXPECT_EQ(mean_ssim(a, a), 1.0);
  const Image<float> black({20, 20}, 0.0f), white({20, 20}, 1.0f);
  EXPECT_NEAR(mean_ssim(black, white), 1e-4 / (1.0 + 1e-4), 1e-9);  // C1 / (1 + C1)
  EXPECT_EQ(mean_ssim(a, black), mean_ssim(black, a));
  EXPECT_TRUE(std::isnan(mean_ssim(Image<float>({10, 40}), Image<float>({10, 40}))));
}

}  // namespace
}  // namespace gnomon::compare
