// A difference of two timed passes, and what its runs leave open.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/result/number_text.h"
#include "scene/base/time_difference.h"

namespace gnomon {
namespace {

TEST(TimeDifference, IsThatOfTheLeastTimesAndReachesTwoStandardErrors) {
  const TimeDifference d = beyond_part({{54.0, 56.0, 55.0}}, {{50.0, 50.0, 50.0}});
  EXPECT_EQ(d.median, 4.0);
  EXPECT_NEAR(d.low, 4.0 - 4.0 / 3.0, 1e-12) << "without the least of them 5, else 4";
  EXPECT_NEAR(d.high, 4.0 + 4.0 / 3.0, 1e-12);
  EXPECT_TRUE(d.told);
}

// Each run has a strip in which the machine did something else, so that no two whole runs agree.
TEST(TimeDifference, StripsTellWhatWholeRunsDoNot) {
  const std::vector<TimedStrip> strips{{{{12.0, 52.0, 12.0}}, {{10.0, 10.1, 10.0}}},
                                       {{{42.0, 12.1, 12.0}}, {{10.0, 10.0, 70.0}}},
                                       {{{12.0, 12.0, 12.2}}, {{90.0, 10.0, 10.0}}}};
  const TimeDifference d = beyond_part(strips);
  EXPECT_NEAR(d.median, 6.0, 1e-9);
  EXPECT_TRUE(d.told);
  EXPECT_LT(d.high - d.low, 1.0);
  Times whole, part;
  for (const TimedStrip& strip : strips) whole.add_part(strip.whole), part.add_part(strip.part);
  EXPECT_EQ(d.pairs.runs.size(), 3u);
  EXPECT_EQ(d.pairs.runs, beyond_part(whole, part).pairs.runs) << "as measured, over all strips";
  EXPECT_FALSE(beyond_part(whole, part).told);
  EXPECT_FALSE(beyond_part(std::span<const TimedStrip>()).timed());
}

// Each strip has a spread of its own, so that two runs of several tell as much as three of one.
TEST(TimeDifference, TwoRunsOfStripsHaveASpread) {
  const std::vector<TimedStrip> strips{{{{12.0, 13.0}}, {{10.0, 10.0}}}, {{{12.0, 12.0}}, {{10.0, 12.0}}}};
  const TimeDifference d = beyond_part(strips);
  EXPECT_NEAR(d.median, 4.0, 1e-12);
  EXPECT_NEAR(d.high - d.median, 2.0 * std::sqrt(0.25 + 1.0), 1e-12)
      << "half of 1 and half of 2: their variances";
  EXPECT_TRUE(d.told);
  const TimeDifference one = beyond_part(std::span(strips).first(1));
  EXPECT_NEAR(one.high - one.median, 2.5, 1e-12) << "a quarter of the part: of two runs nobody can tell";
}

TEST(TimeDifference, APassHasASpread) {
  const TimeDifference three = with_spread({{10.0, 12.0, 11.0}}), one = with_spread({{8.0}});
  EXPECT_EQ(three.low, 8.0) << "the least, less what they spread";
  EXPECT_EQ(three.median, 11.0);
  EXPECT_EQ(three.high, 14.0);
  EXPECT_EQ(one.low, 6.0) << "a single run may be off by a quarter";
  EXPECT_EQ(one.high, 10.0);
  EXPECT_FALSE(with_spread({}).timed());
}

TEST(TimeDifference, IsNeverBelowNothing) {
  for (const std::vector<double>& part :
       {std::vector{90.0, 91.0, 99.0}, std::vector{250.0, 251.0, 252.0}, std::vector{85.0, 91.0, 88.0}}) {
    const TimeDifference d = beyond_part({{88.0, 90.0, 87.0}}, {part});
    EXPECT_EQ(d.low, 0.0);
    EXPECT_GE(d.median, 0.0);
    EXPECT_GE(d.high, Times{part}.least() - 87.0) << "what made it less than nothing can make it more";
    EXPECT_FALSE(d.told);
  }
}

TEST(TimeDifference, OneOfFiveRunsMayBeFarOff) {
  const TimeDifference d = beyond_part({{55.0, 300.0, 56.0, 54.0, 55.5}}, {{50.0, 50.0, 50.0, 50.0, 50.0}});
  EXPECT_TRUE(d.told);
  EXPECT_LT(d.high, 10.0);
}

TEST(TimeDifference, FewRunsAreOffByAQuarter) {
  EXPECT_FALSE(beyond_part({{60.0}}, {{50.0}}).told);
  EXPECT_TRUE(beyond_part({{70.0}}, {{50.0}}).told);
  EXPECT_EQ(beyond_part({{70.0}}, {{50.0}}).high, 32.5);
  EXPECT_FALSE(beyond_part({}, {{50.0}}).timed());
}

TEST(TimeDifference, SumsOfSeveralLightsAreToldWhereEachIs) {
  TimeDifference sum;
  sum += beyond_part({{54.0, 56.0, 55.0}}, {{50.0, 50.0, 50.0}});
  EXPECT_TRUE(sum.told);
  sum += 10.0;
  EXPECT_EQ(sum.median, 14.0);
  sum += beyond_part({{50.0, 51.0, 49.0}}, {{50.0, 50.0, 50.0}});
  EXPECT_FALSE(sum.told);
  EXPECT_NEAR(sum.low, 14.0 - 4.0 / 3.0, 1e-12);
}

TEST(ClearlyFaster, NeitherIsWhereTheRunsOverlap) {
  const Times a{{10.0, 11.0, 12.0}}, b{{11.5, 13.0, 12.5}}, c{{14.0, 15.0, 16.0}};
  EXPECT_FALSE(clearly_faster(a, b, false));
  EXPECT_FALSE(clearly_faster(b, a, false));
  EXPECT_TRUE(clearly_faster(a, c, false));
  EXPECT_FALSE(clearly_faster(c, a, false));
  EXPECT_FALSE(clearly_faster({}, a, false));
  EXPECT_TRUE(clearly_faster(a, c, true)) << "by 4 in each turn";
  EXPECT_FALSE(clearly_faster({{10.0, 11.0, 12.0}}, {{11.0, 16.0, 12.0}}, true)) << "by 0, 1 or 5";
}

TEST(TimeDifference, IsSaidWithItsIntervalOrAsTheIntervalAlone) {
  using compare::milliseconds;
  EXPECT_EQ(milliseconds(beyond_part({{54.0, 56.0, 55.0}}, {{50.0, 50.0, 50.0}})), "4 ms (2.7 to 5.3 ms)");
  EXPECT_EQ(milliseconds(beyond_part({{60.0, 62.0, 64.0}}, {{60.0, 60.0, 60.0}})), "0 to 2.7 ms");
  EXPECT_EQ(milliseconds(beyond_part({{55.0, 55.0, 55.0}}, {{50.0, 50.0, 50.0}})), "5 ms");
  EXPECT_EQ(milliseconds(TimeDifference{}), "not timed");
}

}  // namespace
}  // namespace gnomon
