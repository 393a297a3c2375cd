// The heatmap's fixed scale and legend, and the rows of gnomon bench.
#include <gtest/gtest.h>

#include "app/outputs/heatmap.h"
#include "benchmark/row.h"
#include "compare/result/palette.h"

namespace gnomon::app {
namespace {

using bench::BenchPeer;
using bench::BenchRow;

TEST(Heatmap, ScaleIsFixedAndLogarithmic) {
  EXPECT_EQ(heat_share(0), 0.0);
  EXPECT_DOUBLE_EQ(heat_share(63), 0.5);  // 2^6 - 1 on a scale that ends at 2^12 - 1
  EXPECT_EQ(heat_share(4095), 1.0);
  EXPECT_EQ(heat_share(1000000), 1.0);
}

TEST(Heatmap, PixelsKeepTheirColourWhateverTheOthersAre) {
  Image<raytrace::WorkCounts> work(ImageSize{64, 2});
  work.at(3, 1) = {.boxes = 63, .primitives = 4095};
  const Rgb8Image nodes = heatmap_image(work, HeatmapOf::nodes);
  const Rgb8Image triangles = heatmap_image(work, HeatmapOf::triangles);
  EXPECT_EQ(nodes.at(0, 0), compare::viridis(0.0));
  EXPECT_EQ(nodes.at(3, 1), compare::viridis(0.5));
  EXPECT_EQ(triangles.at(3, 1), compare::viridis(1.0));
  ASSERT_GT(nodes.size.height, 2);
  EXPECT_EQ(nodes.at(63, 2), compare::viridis(63.5 / 64.0));  // the legend's end
}

TEST(BenchRow, RatioAboveOneIsAlwaysBetter) {
  BenchRow speed{.name = "s", .scene = "x", .value = 4.0, .unit = "Mrays/s", .peer = BenchPeer{"p", 2.0}};
  BenchRow time{.name = "t",
                .scene = "x",
                .value = 4.0,
                .unit = "ms",
                .more_is_better = false,
                .peer = BenchPeer{"p", 2.0}};
  EXPECT_EQ(speed.ratio(), 2.0);
  EXPECT_EQ(time.ratio(), 0.5);
  speed.goal = 1.5;
  const std::string json = bench_json(std::vector{speed, time}, compare::MachineInfo{});
  EXPECT_NE(json.find("\"gnomon/bench/1\""), std::string::npos);
  EXPECT_NE(json.find("\"met\": true"), std::string::npos);
  EXPECT_NE(json.find("\"goal\": null"), std::string::npos);
}

TEST(BenchRow, WhatTakesNothingMeetsItsGoal) {
  for (const double asked : {0.0, 8.0}) {
    const BenchRow row{.name = "rays",
                       .scene = "x",
                       .value = 0.0,
                       .unit = "rays",
                       .more_is_better = false,
                       .peer = BenchPeer{"p", asked},
                       .goal = 33.0};
    EXPECT_FALSE(row.ratio().has_value()) << asked;
    EXPECT_TRUE(row.met().value_or(false)) << asked;
    EXPECT_NE(bench_json(std::vector{row}, compare::MachineInfo{}).find("\"met\": true"), std::string::npos)
        << asked;
  }
}

}  // namespace
}  // namespace gnomon::app
