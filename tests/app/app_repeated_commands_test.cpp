// Commands that sweep and tune hand out, to make one of their results again; and what their limits are of.
#include <gtest/gtest.h>

#include "app/options/shimmer_options.h"
#include "app/sweep/command.h"
#include "app/tune/tune_answer.h"

namespace gnomon::app {
namespace {

TEST(RepeatedCommands, ACellIsDrawnByTheSameBackendAndFilmedWhereItWas) {
  SweepCommand command;
  command.scene.name = "fence";
  command.backend = raster::Backend::osmesa;
  std::vector<compare::Axis> axes;
  axes.push_back({"map-size", {"64", "128"}});
  auto grid = compare::Grid::make(std::move(axes), false);
  ASSERT_TRUE(grid.has_value());
  const Plan plan = make_plan(std::move(*grid), command.shard);
  EXPECT_EQ(compare_command(command, plan, 1), "gnomon compare fence --map-size 128 --backend osmesa");
  command.metric.metric = Metric::shimmer;
  command.metric.film.given.emplace_back("--frames", "3");
  EXPECT_EQ(compare_command(command, plan, 1),
            "gnomon shimmer fence --map-size 128 --frames 3 --backend osmesa");
}

TEST(RepeatedCommands, AnAnswerNamesItsBackend) {
  TuneQuestion question;
  question.scene.name = "fence";
  question.backend = raster::Backend::osmesa;
  const std::vector<OptionFamily> families(1);
  compare::TuneResult result;
  compare::FamilyResult& family = result.families.emplace_back();
  family.closest.size = 64;
  family.closest.reads_bias = false;
  const TuneAnswer answer{question, families, result};
  EXPECT_EQ(answer.line(0), "gnomon compare fence --map-size 64 --backend osmesa");
}

TEST(Metric, APlainLimitOfFilmsIsOneOfFlips) {
  const compare::Figure *both = &compare::wrong_and_mean(), *mean = compare::find_measure("mean"),
                        *shimmer = compare::find_measure("shimmer");
  const auto finished = [](Metric metric, const compare::Figure* measure) {
    MetricOptions options;
    options.metric = metric;
    std::optional<compare::Threshold> limit = compare::Threshold{measure, 0.1};
    return finish_metric(options, limit) ? std::optional(limit->measure) : std::nullopt;
  };
  EXPECT_EQ(finished(Metric::shimmer, both), shimmer);
  EXPECT_EQ(finished(Metric::shimmer, shimmer), shimmer);
  EXPECT_EQ(finished(Metric::still, both), both);
  EXPECT_EQ(finished(Metric::still, shimmer), shimmer);
  EXPECT_FALSE(finished(Metric::shimmer, mean).has_value());
}

}  // namespace
}  // namespace gnomon::app
