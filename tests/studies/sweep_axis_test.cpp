// Lists and ranges of a sweep, and the cells they make.
#include <gtest/gtest.h>

#include "studies/sweep/axis.h"

namespace gnomon::studies {
namespace {

using Texts = std::vector<std::string>;

Texts expanded(std::string_view text, ValueKind kind = ValueKind::number) {
  const auto values = expand_values(text, kind);
  EXPECT_TRUE(values) << text << ": " << (values ? "" : values.error().message());
  return values.value_or(Texts{});
}

std::string refusal(std::string_view text, ValueKind kind = ValueKind::number) {
  const auto values = expand_values(text, kind);
  if (values) return "";
  EXPECT_EQ(values.error().kind, ErrorKind::usage);
  return values.error().message();
}

TEST(Axis, Lists) {
  EXPECT_EQ(expanded("hard"), Texts{"hard"});
  EXPECT_EQ(expanded("128,512"), (Texts{"128", "512"}));
  EXPECT_EQ(expanded("0.5texel,0.02"), (Texts{"0.5texel", "0.02"}));
  EXPECT_EQ(expanded("sun:1,lamp", ValueKind::word), (Texts{"sun:1", "lamp"}));
  EXPECT_EQ(expanded("0,30/90,45", ValueKind::numbers), (Texts{"0,30", "90,45"}));
}

TEST(Axis, LinearRangesHoldBothEndsExactly) {
  EXPECT_EQ(expanded("0:1:5"), (Texts{"0", "0.25", "0.5", "0.75", "1"}));
  EXPECT_EQ(expanded("4:-4:3"), (Texts{"4", "0", "-4"}));
  EXPECT_EQ(expanded("0:4texel:3"), (Texts{"0texel", "2texel", "4texel"}));
  EXPECT_EQ(expanded("1texel:2texel:2,5"), (Texts{"1texel", "2texel", "5"}));
  const Texts many = expanded("0:0.1:64");
  EXPECT_EQ(many.size(), 64u);
  EXPECT_EQ(many.back(), "0.1");
  EXPECT_EQ(many[21], "0.0333333333333");
  EXPECT_EQ(expanded("0:0.1:6"), (Texts{"0", "0.02", "0.04", "0.06", "0.08", "0.1"}));
  EXPECT_EQ(expanded("0,30:270,30:4", ValueKind::numbers), (Texts{"0,30", "90,30", "180,30", "270,30"}));
}

TEST(Axis, FactorRangesStopAtTheEnd) {
  EXPECT_EQ(expanded("128:8192:x2"), (Texts{"128", "256", "512", "1024", "2048", "4096", "8192"}));
  EXPECT_EQ(expanded("100:1000:x3"), (Texts{"100", "300", "900"}));
  EXPECT_EQ(expanded("0.001:1:x10").size(), 4u);  // the end is met although 0.001 is no binary number
  EXPECT_EQ(expanded("0.07:70:x10"), (Texts{"0.07", "0.7", "7", "70"}));
}

TEST(Axis, RefusesWhatIsNoRange) {
  for (const char* text :
       {"", "1,", "1:2", "1:2:3:4", "a:b:3", "0:1:0", "0:1:1", "0:1:2.5", "0:1:x1", "0:1:x2", "1:0:x2",
        "1texel:2m:3", "0:1:1000000", "nan:1:3", "0:inf:3", "+-0.1:0.1:3"})
    EXPECT_NE(refusal(text), "") << text;
  EXPECT_EQ(refusal("0:1:x2"), "the ends of a ×-range (got 0:1:x2, allowed 0 < START <= END)");
  EXPECT_NE(refusal("0,1:2:3", ValueKind::numbers), "");
  EXPECT_NE(refusal("1,1:8,8:x2", ValueKind::numbers), "");
}

TEST(Grid, ProductRunsTheLastAxisFastest) {
  const auto grid = Grid::make({{"map-size", {"1", "2"}}, {"bias", {"a", "b", "c"}}}, false);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->cells(), 6u);
  Texts cells;
  for (std::size_t i = 0; i < 6; ++i) cells.push_back(grid->value(0, i) + grid->value(1, i));
  EXPECT_EQ(cells, (Texts{"1a", "1b", "1c", "2a", "2b", "2c"}));
  EXPECT_FALSE(Grid::make({{"bias", {"1", "1"}}}, false));
  EXPECT_EQ(Grid::make({}, false)->cells(), 1u);
}

TEST(Grid, ZipPairsAxesOfOneLength) {
  const auto grid = Grid::make({{"map-size", {"1", "2"}}, {"cull", {"none"}}, {"bias", {"b", "b"}}}, true);
  ASSERT_TRUE(grid) << grid.error().message();
  ASSERT_EQ(grid->cells(), 2u);
  EXPECT_EQ(grid->position(1), (std::vector<std::size_t>{1, 0, 1}));
  const auto uneven = Grid::make({{"a", {"1", "2"}}, {"b", {"1", "2", "3"}}}, true);
  ASSERT_FALSE(uneven);
  EXPECT_EQ(uneven.error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace gnomon::studies
