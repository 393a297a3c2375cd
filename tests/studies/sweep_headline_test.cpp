// Which cells of a sweep are worth having, and what is said of the best.
#include <gtest/gtest.h>

#include "studies/sweep/headline.h"

namespace gnomon::studies {
namespace {

CellSummary cell(std::size_t index, double error, double ms, double spread, std::uint64_t texels) {
  CellSummary out;
  out.cell = index;
  out.axes = {{"map_size", std::to_string(texels)}};
  out.figures.pixels.compared = 1000;
  out.figures.error.wrong_fraction = out.figures.error.mean_absolute = error;
  out.lights = {out.figures};
  out.raster_ms = ms, out.raster.runs = {ms - 0.5 * spread, ms, ms + 0.5 * spread};
  out.map_texels = texels;
  return out;
}

using Indices = std::vector<std::size_t>;

TEST(ParetoFront, ATimeInsideTheNoiseIsNotWorthHaving) {
  const std::vector<CellSummary> cells{cell(0, 0.10, 10.0, 1.0, 64), cell(1, 0.05, 10.5, 1.0, 128),
                                       cell(2, 0.01, 20.0, 1.0, 256), cell(3, 0.02, 25.0, 1.0, 512)};
  // 0 is faster than 1 by half of what either is off by, 3 is beaten by 2.
  EXPECT_EQ(pareto_front(cells), (Indices{1, 2}));
}

TEST(ParetoFront, CellsWithoutASpreadAreOnNone) {
  std::vector<CellSummary> cells{cell(0, 0.10, 9.0, 0.0, 64), cell(1, 0.05, 90.0, 0.0, 128)};
  EXPECT_EQ(pareto_front(cells), (Indices{0, 1})) << "three runs without any spread";
  for (CellSummary& c : cells) c.raster.runs.resize(1);
  EXPECT_TRUE(pareto_front(cells).empty());
  const std::vector<std::string> lines = sweep_headline(cells, pareto_front(cells), {}).lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].starts_with("Least error: cell 1 ")) << lines[0];
  EXPECT_EQ(lines[1], "No cell is best for time, since fewer than three runs have no spread.");
}

TEST(ParetoFront, CellsOfOneDrawingAreOnNone) {
  std::vector<CellSummary> cells{cell(0, 0.10, 9.0, 0.0, 64), cell(1, 0.05, 9.0, 0.0, 64)};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].axes = {{"map_size", "64"}, {"bias", std::to_string(i)}};
    cells[i].derived = i > 0;
  }
  EXPECT_TRUE(pareto_front(cells).empty());
  const std::vector<std::string> lines = sweep_headline(cells, pareto_front(cells), {}).lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "All cells come from one drawing, so none is best for time.");
  cells[1].axes[0].second = "128", cells[1].derived = false;
  EXPECT_FALSE(share_one_drawing(cells));
  EXPECT_EQ(pareto_front(cells), (Indices{1}));
}

TEST(SweepHeadline, SaysWhatTheBestCellsShadowsCostOnBothSides) {
  std::vector<CellSummary> cells{cell(0, 0.10, 10.0, 1.0, 64), cell(1, 0.02, 12.0, 1.0, 128)};
  const TimeDifference map = with_spread({{4.0, 4.0, 4.0}}), rays = with_spread({{7.0, 7.0, 7.0}});
  cells[1].costs = compare::ShadowCosts{{map, rays}, {map, rays}, {map, {}}};
  const std::vector<std::string> lines = sweep_headline(cells, pareto_front(cells), {}).lines();
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[3], "Shadows of cell 1, nothing moves: 4 ms by the map, 7 ms by rays.");
  EXPECT_EQ(lines[5], "Shadows of cell 1, casters move: 4 ms by the map, not timed by rays.");
}

TEST(ParetoFront, OfEqualErrorsTheLeastCostCountsAndNotTheNoise) {
  EXPECT_EQ(pareto_front({cell(0, 0.01, 10.0, 1.0, 4096), cell(1, 0.01, 10.4, 1.0, 64)}), (Indices{1}));
  EXPECT_EQ(pareto_front({cell(0, 0.01, 10.0, 1.0, 4096), cell(1, 0.01, 14.0, 1.0, 64)}), (Indices{0}));
}

TEST(ParetoFront, UntimedCellsAreOnNone) {
  EXPECT_TRUE(pareto_front({cell(0, 0.1, std::numeric_limits<double>::quiet_NaN(), 0.0, 64)}).empty());
}

TEST(SweepHeadline, NamesTheBestForErrorForTimeAndForBoth) {
  const std::vector<CellSummary> cells{cell(0, 0.10, 10.0, 1.0, 64), cell(1, 0.02, 12.0, 1.0, 128),
                                       cell(2, 0.01, 90.0, 1.0, 256)};
  const Headline said =
      sweep_headline(cells, pareto_front(cells), compare::Threshold{compare::find_measure("wrong"), 0.05});
  const std::vector<std::string> lines = said.lines();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0],
            "Cheapest with at most 5.0 % wrong: cell 1 (map size 128) with 2.0 % wrong, mean error 2.0 %, "
            "12 ms.");
  EXPECT_TRUE(lines[1].starts_with("Best for error: cell 2 ")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("Best for time: cell 0 ")) << lines[2];
  EXPECT_TRUE(lines[3].starts_with("Best for both (least product of error and time): cell 1 ")) << lines[3];
  EXPECT_TRUE(said.limit_met);
  EXPECT_FALSE(
      sweep_headline(cells, pareto_front(cells), compare::Threshold{compare::find_measure("mean"), 0.005})
          .limit_met);
}

TEST(SweepHeadline, SaysThatTimesWithinTheirSpreadAreEqual) {
  const std::vector<CellSummary> cells{cell(0, 0.10, 10.0, 1.0, 64), cell(1, 0.05, 10.4, 1.0, 64),
                                       cell(2, 0.01, 90.0, 1.0, 256)};
  const std::vector<std::string> lines = sweep_headline(cells, pareto_front(cells), {}).lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[1].starts_with("Best for time (a tie within the spread of the times): cell 1 "))
      << lines[1];
}

TEST(SweepWords, ShortenLongNumbersAndNothingElse) {
  EXPECT_EQ(axis_words("map_size"), "map size");
  EXPECT_EQ(label_words_of("peter_panning"), "peter-panning");
  EXPECT_EQ(label_words_of(""), "");
  for (const auto& [value, words] : {std::pair("0.00869565217391", "0.008696"),
                                     {"0.0333333333333texel", "0.03333texel"},
                                     {"0.125", "0.125"},
                                     {"2048", "2048"},
                                     {"second-depth", "second-depth"},
                                     {"", ""}})
    EXPECT_EQ(value_words(value), words);
}

}  // namespace
}  // namespace gnomon::studies
