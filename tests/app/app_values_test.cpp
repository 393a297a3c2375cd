// The text of option values, suggestions, line breaking, and the picture's exposure.
#include "app/options/values.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/help/manual.h"
#include "app/process/machine.h"
#include "raster/settings.h"
#include "scene/base/option_text.h"
#include "scene/exposure.h"

namespace gnomon::app {
namespace {

TEST(Values, NumbersAreWholeTextsAndFinite) {
  const OptionRange range{-1.0, 2.0};
  EXPECT_EQ(parse_number("1.5", range).value(), 1.5);
  EXPECT_EQ(parse_number("+1e-3", range).value(), 1e-3);
  EXPECT_EQ(parse_number("-1", range).value(), -1.0);
  for (const char* text : {"", " 1", "1 ", "1,5", "0x1", "nan", "-nan", "inf", "-inf", "1e400", "2.0000001",
                           "one", "1m", "+-1"}) {
    const Expected<double> value = parse_number(text, range);
    ASSERT_FALSE(value) << text;
    EXPECT_EQ(value.error().kind, ErrorKind::usage);
    EXPECT_NE(value.error().reason.find("(got " + std::string(text) + ", allowed -1 to 2)"),
              std::string::npos);
  }
  EXPECT_FALSE(parse_number("0", {0.0, 1.0, true})) << "the excluded end";
}

TEST(Values, IntegersDoNotWrap) {
  EXPECT_EQ(parse_integer("1024", 1, 65536).value(), 1024);
  for (const char* text : {"0", "-1", "65537", "2147483648", "99999999999999999999", "1.0", "1e3", ""}) {
    EXPECT_FALSE(parse_integer(text, 1, 65536)) << text;
  }
  EXPECT_EQ(parse_unsigned("18446744073709551615").value(), UINT64_MAX);
  EXPECT_FALSE(parse_unsigned("18446744073709551616"));
  EXPECT_FALSE(parse_unsigned("-1"));
}

TEST(Values, Thresholds) {
  using compare::find_measure, compare::Threshold, compare::wrong_and_mean;
  for (const auto& [text, wanted] :
       std::vector<std::pair<const char*, Threshold>>{{"1%", {&wrong_and_mean(), 0.01}},
                                                      {"0.25", {&wrong_and_mean(), 0.25}},
                                                      {"wrong:1%", {find_measure("wrong"), 0.01}},
                                                      {"mean:0.5%", {find_measure("mean"), 0.005}},
                                                      {"flip:0.05", {find_measure("flip"), 0.05}},
                                                      {"edge:0.5texel", {find_measure("edge"), 0.5}},
                                                      {"edge:2texels", {find_measure("edge"), 2.0}}}) {
    const auto parsed = parse_threshold(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(*parsed, wanted) << text;
    const auto again = parse_threshold(compare::threshold_text(*parsed));
    ASSERT_TRUE(again) << compare::threshold_text(*parsed);
    EXPECT_EQ(*again, wanted) << text;
  }
  EXPECT_EQ(parse_threshold("0.5", *find_measure("edge")).value(), (Threshold{find_measure("edge"), 0.5}));
  EXPECT_EQ(parse_threshold("1%", *find_measure("mean")).value(), (Threshold{find_measure("mean"), 0.01}));
  EXPECT_EQ(parse_threshold("wrong:1%", *find_measure("mean")).value(),
            (Threshold{find_measure("wrong"), 0.01}))
      << "what names a measure means it";
  for (const char* text : {"", "101%", "-1%", "median:1%", ":1%", "wrong:", "wrong:2", "flip:1.5",
                           "edge:-1texel", "edge:1px", "edge:1texeltexels", "mean:1%x", "wrong and mean:1%"})
    EXPECT_FALSE(parse_threshold(text)) << text;
}

// A bare number is a share of 1, so that "1" would mean 100 %: who means one per cent is told.
TEST(Values, ABareOneIsNoLimit) {
  for (const char* text : {"1", "1.0", "wrong:1", "mean:1"}) {
    const auto parsed = parse_threshold(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().reason, "1 is all, and may be meant as one per cent (got " + std::string(text) +
                                         ", allowed 1% or 0.01, or 100%)");
  }
  for (const char* text : {"1%", "0.01", "0.99", "100%", "edge:1", "flip:1"})
    EXPECT_TRUE(parse_threshold(text)) << text;
}

TEST(Values, Sizes) {
  EXPECT_EQ(parse_size("1280x720").value(), (ImageSize{1280, 720}));
  EXPECT_EQ(parse_size("16384x1").value(), (ImageSize{16384, 1}));
  EXPECT_EQ(parse_size("1080p").value(), (ImageSize{1920, 1080}));
  EXPECT_EQ(parse_size("4k").value(), (ImageSize{3840, 2160}));
  EXPECT_EQ(parse_size("8k").value(), (ImageSize{7680, 4320}));
  for (const char* text : {"", "x", "1x", "x1", "0x1", "1x0", "-1x1", "1280X720", "1280", "1x1x1", "16385x1",
                           "2147483648x1", "4294967297x1", "1.5x2", "nanxnan", "1080", "2k"}) {
    EXPECT_FALSE(parse_size(text)) << text;
  }
}

TEST(Values, BiasesSayTheirUnit) {
  EXPECT_EQ(raster::parse_bias("0.02")->constant, 0.02);
  EXPECT_EQ(raster::parse_bias("0.02")->unit, raster::BiasUnit::world);
  for (const char* text : {"0.5texel", "0.5texels"}) {
    EXPECT_EQ(raster::parse_bias(text)->constant, 0.5);
    EXPECT_EQ(raster::parse_bias(text)->unit, raster::BiasUnit::texel);
  }
  EXPECT_EQ(raster::parse_bias("-0.1")->constant, -0.1);
  for (const char* text :
       {"", "texel", "nan", "inf", "infinity", "nantexel", "1 texel", "0.5px", "0.5texeltexels", "1e31"}) {
    EXPECT_FALSE(raster::parse_bias(text)) << text;
  }
}

TEST(Values, SharesAndExposures) {
  EXPECT_DOUBLE_EQ(parse_share("1%").value(), 0.01);
  EXPECT_DOUBLE_EQ(parse_share("0.25").value(), 0.25);
  EXPECT_EQ(parse_share("0").value(), 0.0);
  for (const char* text : {"", "%", "101%", "1.1", "-1%", "nan", "1%%"})
    EXPECT_FALSE(parse_share(text)) << text;
  EXPECT_EQ(parse_exposure("auto").value(), std::nullopt);
  EXPECT_EQ(parse_exposure("2").value(), 2.0);
  for (const char* text : {"", "0", "-1", "nan", "Auto"}) EXPECT_FALSE(parse_exposure(text)) << text;
}

RC_GTEST_PROP(Values, NumbersReadBackExactly, (double value)) {
  RC_PRE(std::isfinite(value));
  const OptionRange any{-1e308, 1e308};
  RC_PRE(std::abs(value) <= 1e308);
  RC_ASSERT(parse_number(number_text(value), any).value() == value);
}

TEST(Suggestions, SlipsAreFoundAndStrangersAreNot) {
  const std::string_view known[] = {"compare", "raster", "raytrace", "plan", "scenes"};
  EXPECT_EQ(nearest_name("comapre", known), "compare");
  EXPECT_EQ(nearest_name("rastre", known), "raster");
  EXPECT_EQ(nearest_name("scene", known), "scenes");
  EXPECT_EQ(nearest_name("render", known), "");
  EXPECT_EQ(nearest_name("", known), "");
  EXPECT_EQ(nearest_name("CMOPARE", known), "compare") << "whatever its case";
  EXPECT_EQ(did_you_mean("pla", known), "; did you mean plan?");
}

TEST(Wrap, KeepsWordsAndWidth) {
  EXPECT_EQ(wrap("one two three", 2, 9), "  one two\n  three\n");
  EXPECT_EQ(wrap("unbreakable", 0, 4), "unbreakable\n");
}

ColorImage grey_ramp(int pixels) {
  ColorImage image(ImageSize{pixels, 1});
  for (int x = 0; x < pixels; ++x) image.at(x, 0) = Vec3f(static_cast<float>(x + 1));
  return image;
}

TEST(Exposure, BringsThe95thPercentileTo80Percent) {
  // Luminances 1 … 100: the 95th percentile by nearest rank is 95. The weights sum to 1 within a float's
  // rounding.
  EXPECT_NEAR(auto_exposure(grey_ramp(100)), 0.8 / 95.0, 1e-8);
}

TEST(Exposure, BlackAndBrokenPixelsDoNotCount) {
  ColorImage image = grey_ramp(100);
  const double expected = auto_exposure(image);
  image.data.resize(300, Vec3f(0.0f));
  image.data[150] = Vec3f(std::numeric_limits<float>::quiet_NaN());
  image.data[151] = Vec3f(std::numeric_limits<float>::infinity());
  EXPECT_EQ(auto_exposure(image), expected);
  EXPECT_EQ(auto_exposure(ColorImage(ImageSize{4, 4})), 1.0);
}

// Against sorting, over many powers of two and with many equal pixels.
TEST(Exposure, IsTheSortedListsPercentile) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-30.0f, 20.0f);
  for (const int width : {1, 2, 3, 19, 20, 21, 700}) {
    ColorImage image(ImageSize{width, width});
    std::vector<float> sorted;
    for (Vec3f& pixel : image.data) {
      const float value = random() % 4 == 0 ? 0.5f : random() % 9 == 0 ? 0.0f : std::exp2(exponent(random));
      pixel = Vec3f(value);
      const float luminance = glm::dot(Vec3f(0.2126f, 0.7152f, 0.0722f), pixel);
      if (luminance > 0.0f) sorted.push_back(luminance);
    }
    if (sorted.empty()) continue;
    std::sort(sorted.begin(), sorted.end());
    const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(sorted.size()))) - 1;
    EXPECT_EQ(auto_exposure(image), 0.8 / static_cast<double>(sorted[rank])) << width;
  }
}

TEST(Bytes, TakeUnitsOf1024) {
  EXPECT_EQ(*parse_bytes("1048576"), 1048576.0);
  EXPECT_EQ(*parse_bytes("500M"), 500.0 * 1024.0 * 1024.0);
  EXPECT_EQ(*parse_bytes("1.5k"), 1536.0);
  EXPECT_EQ(*parse_bytes("2G"), 2.0 * 1024.0 * 1024.0 * 1024.0);
  EXPECT_EQ(*parse_bytes("1t"), std::ldexp(1.0, 40));
}

TEST(Bytes, AreRefusedWithWhatWasGiven) {
  for (const std::string text : {"", "G", "-1", "nan", "1e400", "12Q", "2GB", "2 G", "1,5G"}) {
    const auto bytes = parse_bytes(text);
    ASSERT_FALSE(bytes) << text;
    EXPECT_EQ(bytes.error().kind, ErrorKind::usage) << text;
    EXPECT_NE(bytes.error().message().find("got " + text), std::string::npos) << bytes.error().message();
  }
}

}  // namespace
}  // namespace gnomon::app
