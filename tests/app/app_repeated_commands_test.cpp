// Commands that sweep and tune hand out, to make one of their results again; and what their limits are of.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "app/lesson_scene.h"
#include "app/options/options.h"
#include "app/options/shimmer_options.h"
#include "raster/settings.h"
#include "studies/commands/sweep_command.h"
#include "studies/commands/tune_answer.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::app {
namespace {

TEST(RepeatedCommands, ACellIsDrawnByTheSameBackendAndFilmedWhereItWas) {
  SweepCommand command;
  command.scene.name = "fence";
  command.backend = raster::Backend::osmesa;
  std::vector<studies::Axis> axes;
  axes.push_back({"map-size", {"64", "128"}});
  auto grid = studies::Grid::make(std::move(axes), false);
  ASSERT_TRUE(grid.has_value());
  const Plan plan = make_plan(std::move(*grid), command.shard);
  EXPECT_EQ(compare_command(command, plan, 1), "gnomon compare fence --map-size 128 --backend osmesa");
  command.asked.measure = compare::find_measure("mean");
  EXPECT_EQ(compare_command(command, plan, 1),
            "gnomon compare fence --map-size 128 --measure mean --backend osmesa");
  command.asked.measure = compare::find_measure("shimmer");
  command.asked.film.given.emplace_back("--frames", "3");
  EXPECT_EQ(compare_command(command, plan, 1),
            "gnomon shimmer fence --map-size 128 --frames 3 --backend osmesa");
}

TEST(RepeatedCommands, AnAnswerNamesItsBackend) {
  TuneQuestion question;
  question.scene.name = "fence";
  question.backend = raster::Backend::osmesa;
  const std::vector<OptionFamily> families(1);
  studies::TuneResult result;
  studies::FamilyResult& family = result.families.emplace_back();
  family.closest.size = 64;
  family.closest.reads_bias = false;
  const TuneAnswer answer{question, families, result};
  EXPECT_EQ(answer.line(0), "gnomon compare fence --map-size 64 --backend osmesa");
}

/// A command with these values draws what they alone draw: what the lesson, or the scene's file, would add is set back.
TEST(RepeatedCommands, WhatTheSceneAsksForIsSetBack) {
  const OptionValues constant{{"technique", "hard"}, {"bias", "0.06"}};
  OptionValues settled = constant;
  settled.emplace_back("normal-offset", "0");
  EXPECT_EQ(settled_values("light-leaks", constant), settled) << "a lesson: --bias 0.02 --normal-offset 8";
  EXPECT_EQ(settled_values("thin-wall", constant), constant) << "the scene alone asks for nothing";
  EXPECT_EQ(settled_values("light-leaks", {{"technique", "pcf"}}), (OptionValues{{"technique", "pcf"}}))
      << "the lesson's settings are of another technique";
  EXPECT_EQ(settled_values("filtering", {{"map-size", "512"}}),
            (OptionValues{{"map-size", "512"}, {"technique", "hard"}}))
      << "the lesson would make it pcf";

  const test::TemporaryFolder folder;
  const std::string scene = folder.put("asks.json", R"({"schema": "gnomon/scene/1", "name": "asks",
    "settings": {"technique": "pcf", "filter-radius": "3", "snap": "true", "slope-bias": "2"}})");
  const OptionValues filtered{{"technique", "pcf"}, {"bias", "0.06"}};
  const OptionValues set_back = settled_values(scene, filtered);
  EXPECT_EQ(raster::words_of(set_back), (std::vector<std::string>{"--technique", "pcf", "--bias", "0.06",
                                                                  "--filter-radius", "1.5", "--snap=false"}))
      << "a bias of any kind takes the place of the file's";
}

struct Asked {
  const compare::Figure *measure, *limit;
};

/// What --measure and --max-error ask for together; nothing where they are refused.
std::optional<Asked> asked(const char* words) {
  CLI::App app;
  const compare::Figure* measure = &compare::wrong_and_mean();
  std::optional<compare::Threshold> limit;
  add_measured_limit(app, "--max-error", {measure, limit}, "", "", true);
  try {
    app.parse(words);
  } catch (const CLI::ParseError&) {
    return std::nullopt;
  }
  return Asked{measure, limit->measure};
}

TEST(Measure, APlainLimitIsOneOfItAndFlipsAreOfFilms) {
  const compare::Figure *both = &compare::wrong_and_mean(), *mean = compare::find_measure("mean"),
                        *shimmer = compare::find_measure("shimmer");
  const std::tuple<const char*, const compare::Figure*, const compare::Figure*> cases[] = {
      {"--measure shimmer --max-error 0.1", shimmer, shimmer},
      {"--max-error 0.1 --measure shimmer", shimmer, shimmer},
      {"--measure shimmer --max-error shimmer:0.1", shimmer, shimmer},
      {"--max-error shimmer:0.1", shimmer, shimmer},
      {"--measure mean --max-error 10%", mean, mean},
      {"--max-error 10%", both, both},
      {"--max-error mean:10%", both, mean}};
  for (const auto& [words, measure, limit] : cases) {
    const auto both_asked = asked(words);
    ASSERT_TRUE(both_asked.has_value()) << words;
    EXPECT_EQ(both_asked->measure, measure) << words;
    EXPECT_EQ(both_asked->limit, limit) << words;
  }
  EXPECT_FALSE(asked("--measure shimmer --max-error mean:10%").has_value());
  EXPECT_FALSE(asked("--max-error shimmer:0.1 --measure mean").has_value());
}

}  // namespace
}  // namespace gnomon::app
