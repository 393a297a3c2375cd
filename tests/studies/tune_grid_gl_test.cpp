// The tuner against full grids on six scenes, in costs that do not depend on the machine: texels rendered and
// texels looked up. (gnomon bench --tune does the same in milliseconds.)
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "scene/load.h"
#include "studies/tune/full_grid.h"
#include "studies/tune/sheet.h"
#include "studies/tune/tuner.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

using compare::Setting;
using raster::Technique;
using studies::GridCheck;
using studies::Probe;
using studies::TuneFamily;
using studies::TuneOptions;

constexpr double allowed = 1.1;  // of the grid's best cost

TuneFamily family(const char* name, Technique technique, double slope = 0.0) {
  TuneFamily out{name, {}};
  out.map.technique = technique;
  out.map.bias = {.constant = 1.0, .unit = raster::BiasUnit::texel, .slope = slope};
  return out;
}

double lookups(Technique technique) {
  return technique == Technique::pcf ? 9.0 : 1.0;
}

// The exact technique has a least size of its own, as lists per texel have: here 64, and dearer than maps.
double cost(const Setting& setting, const Probe& probe) {
  const raster::MapOptions& map = setting.raster.map;
  const auto pixels = static_cast<double>(setting.raster.size.pixels());
  if (map.technique == Technique::izb) return 60.0 * pixels * (1.0 + std::abs(std::log2(map.size / 64.0)));
  return static_cast<double>(probe.map_texels) + pixels * lookups(map.technique);
}

Setting small_setting(const OneWorld& world) {
  Setting base;
  base.raster.size = base.raytrace.size = {128, 72};
  base.raster.runs = 0;
  base.raytrace.picture = false;
  base.camera = world.scene.camera;
  base.lights = world.scene.lights;
  for (std::uint32_t i = 0; i < base.lights.size(); ++i) base.compared.push_back(i);
  return base;
}

GridCheck check(const std::string& scene_name, const studies::TuneGoal& goal) {
  auto scene = load_scene(scene_name);
  if (!scene) {
    ADD_FAILURE() << scene.error().message();
    return {};
  }
  OneWorld world(*scene);
  studies::Engine engine(world.scene, world.world, *world.renderer, false);
  const Setting base = small_setting(world);
  TuneOptions options;
  options.goal = goal;
  options.sizes = {32, 64, 128, 256, 512};
  options.families = {family("constant", Technique::hard), family("slope", Technique::hard, 1.0),
                      family("pcf", Technique::pcf), family("izb", Technique::izb)};
  options.cost = cost;
  const std::vector<raster::Bias> biases{
      {0.25, raster::BiasUnit::texel}, {1.0, raster::BiasUnit::texel}, {4.0, raster::BiasUnit::texel}};
  auto checked = studies::check_against_grid(engine, base, options, biases, 0);
  if (!checked) {
    ADD_FAILURE() << checked.error().message();
    return {};
  }
  return *checked;
}

studies::TuneGoal error_goal(double limit) {
  studies::TuneGoal goal;
  goal.max_error = compare::Threshold{compare::find_measure("wrong"), limit};
  return goal;
}

studies::TuneGoal time_goal(double ms) {
  studies::TuneGoal goal;
  goal.max_time_ms = ms;
  return goal;
}

// The one figure that decides is the one that is printed: of a time that was too long in the search and is not when it is
// measured again, and the other way round.
TEST(TuneAgainstGrid, WhatIsMeasuredLastDecides) {
  OneWorld world(*load_scene("floating-box"));
  studies::Engine engine(world.scene, world.world, *world.renderer, false);
  TuneOptions options;
  options.goal = time_goal(5.0);
  options.sizes = {64, 128};
  options.families = {family("constant", Technique::hard)};
  for (const bool slow_first : {true, false}) {
    std::map<int, int> drawn;
    options.cost = [&](const Setting& setting, const Probe&) {
      return (drawn[setting.raster.map.size]++ == 0) == slow_first ? 9.0 : 3.0;
    };
    const auto tuned = studies::tune(engine, small_setting(world), options);
    ASSERT_TRUE(tuned) << tuned.error().message();
    const studies::FamilyResult& winner = tuned->families[tuned->winner];
    EXPECT_EQ(tuned->feasible, slow_first);
    EXPECT_EQ(winner.attempt().cost, slow_first ? 3.0 : 9.0);
    EXPECT_EQ(winner.why.find("comes nearest") == std::string::npos, slow_first) << winner.why;
  }
}

// Within a cost that a map of 256 keeps and one of 512 does not: nothing of the grid errs less by more than 0.2 points.
TEST(TuneAgainstGrid, AnswersErrNoMoreThanTheGridsBest) {
  for (const char* scene : {"fence", "acne-floor", "floating-box", "thin-wall", "sphere-plane", "teapot"}) {
    const GridCheck checked = check(scene, time_goal(170'000.0));
    ASSERT_TRUE(checked.best) << scene;
    ASSERT_TRUE(checked.tuned.feasible) << scene;
    const studies::FamilyResult& winner = checked.tuned.families[checked.tuned.winner];
    const studies::FamilyResult& best = checked.tuned.families[checked.best->family];
    std::printf("%-14s %3llu of %3llu drawings: %s %d, %.3f %% off; grid %s %d, %.3f %%\n", scene,
                static_cast<unsigned long long>(checked.tune_drawings),
                static_cast<unsigned long long>(checked.grid_drawings), winner.family.name.c_str(),
                winner.answer->size, 100.0 * winner.answer->error, best.family.name.c_str(),
                checked.best->attempt.size, 100.0 * checked.best->attempt.error);
    EXPECT_LE(winner.answer->error, checked.best->attempt.error + 0.002) << scene;
  }
}

TEST(TuneAgainstGrid, AnswersCostNoMoreThanTheGridsBest) {
  std::uint64_t tune_drawings = 0, grid_drawings = 0;
  for (const auto& [scene, max_error] :
       {std::pair("fence", 0.04), std::pair("acne-floor", 0.01), std::pair("floating-box", 0.01),
        std::pair("thin-wall", 0.01), std::pair("sphere-plane", 0.005), std::pair("teapot", 0.03)}) {
    const GridCheck checked = check(scene, error_goal(max_error));
    tune_drawings += checked.tune_drawings, grid_drawings += checked.grid_drawings;
    ASSERT_TRUE(checked.best) << scene << ": no setting of the grid is good enough";
    ASSERT_TRUE(checked.tuned.feasible) << scene;
    const studies::FamilyResult& winner = checked.tuned.families[checked.tuned.winner];
    const studies::FamilyResult& best = checked.tuned.families[checked.best->family];
    std::printf("%-14s %3llu of %3llu drawings, ratio %.3f: %s %d; grid %s %d, %zu good\n", scene,
                static_cast<unsigned long long>(checked.tune_drawings),
                static_cast<unsigned long long>(checked.grid_drawings), checked.ratio(),
                winner.family.name.c_str(), winner.answer->size, best.family.name.c_str(),
                checked.best->attempt.size, checked.good_cells);
    EXPECT_LE(checked.ratio(), allowed) << scene;
    EXPECT_LE(winner.answer->error, max_error) << scene;
  }
  EXPECT_LT(3 * tune_drawings, 2 * grid_drawings);
}

// A goal that only exact shadows meet: their least size is walked to.
TEST(TuneAgainstGrid, ExactTechniqueIsTakenAtItsCheapestSize) {
  const GridCheck checked = check("fence", error_goal(1e-4));
  ASSERT_TRUE(checked.tuned.feasible);
  const studies::FamilyResult& winner = checked.tuned.families[checked.tuned.winner];
  EXPECT_EQ(winner.family.name, "izb");
  EXPECT_EQ(winner.answer->size, 64);
  EXPECT_EQ(checked.ratio(), 1.0);
}

studies::FamilyResult measured(const char* name, double error, std::vector<double> runs_ms,
                               std::uint64_t texels) {
  studies::FamilyResult out;
  out.family.name = name;
  studies::Attempt answer;
  answer.error = error, answer.times.runs = std::move(runs_ms), answer.map_texels = texels;
  answer.cost = answer.time_ms = answer.times.least();
  out.tried = {answer}, out.answer = std::move(answer);
  return out;
}

// Four cascades of 2048 texels take as much as one map of 4096.
TEST(TuneSheet, ComparesAtEqualMemory) {
  const std::vector<int> sizes{256, 512, 1024, 2048, 4096, 8192};
  studies::Attempt cascades;
  cascades.size = 1024, cascades.map_bytes = 4ULL * 4 * 1024 * 1024;
  EXPECT_EQ(studies::size_at_memory(cascades, sizes, 4ULL * 4096 * 4096), 2048);
  studies::Attempt one;
  one.size = 512, one.map_bytes = 4ULL * 512 * 512;
  EXPECT_EQ(studies::size_at_memory(one, sizes, 4ULL * 4 * 2048 * 2048), 4096);
  EXPECT_EQ(studies::size_at_memory(one, sizes, 1), 256) << "the least there is";
}

// Where the goal is an error, times alone tie; where it is a time, the errors have to be the same as well.
TEST(TuneTies, AreToldForBothGoalsAndDecidedByTheCheaper) {
  const std::vector<studies::FamilyResult> families{
      measured("best", 0.01, {10.0, 12.0, 14.0}, 200),
      measured("same error, fewer texels", 0.01, {11.5, 13.0}, 100),
      measured("other error", 0.02, {11.0, 11.5}, 50), measured("slow", 0.01, {16.5, 17.0}, 10)};
  const studies::Ties by_error = studies::ties_with(0, families, error_goal(0.05));
  EXPECT_EQ(by_error.chosen, 2u);
  EXPECT_EQ(by_error.others, (std::vector<std::size_t>{1, 0}));
  const studies::Ties by_time = studies::ties_with(0, families, time_goal(20.0));
  EXPECT_EQ(by_time.chosen, 1u);
  EXPECT_EQ(by_time.others, (std::vector<std::size_t>{0}));
}

TEST(TuneTies, SettingsJustOverTheLimitAreTold) {
  std::vector<studies::FamilyResult> families{
      measured("answer", 0.02, {18.0, 19.0}, 1), measured("more accurate", 0.01, {22.0}, 1),
      measured("less accurate", 0.03, {22.0}, 1), measured("far too slow", 0.001, {26.0}, 1)};
  const auto over = studies::just_over_limit(0, families, time_goal(20.0));
  ASSERT_EQ(over.size(), 1u);
  EXPECT_EQ(over[0].family, 1u);
  EXPECT_TRUE(just_over_limit(0, families, error_goal(0.05)).empty());
}

// The grid and the tuner ask this.
TEST(Tune, WhatIsUncertainOrNotKnownIsNotGood) {
  compare::LightFigures known;
  known.pixels.compared = 1000;
  studies::Attempt attempt;
  studies::set_figures({known}, *compare::find_measure("wrong"), attempt);
  EXPECT_TRUE(is_good(error_goal(0.001), attempt));
  compare::LightFigures doubtful = known;
  doubtful.pixels.uncertain = 100;
  studies::set_figures({doubtful}, *compare::find_measure("wrong"), attempt);
  EXPECT_FALSE(is_good(error_goal(0.001), attempt));
  compare::LightFigures unknown = known;
  unknown.error.wrong_fraction = std::numeric_limits<double>::quiet_NaN();
  studies::set_figures({known, unknown}, *compare::find_measure("wrong"), attempt);
  EXPECT_FALSE(is_good(error_goal(0.001), attempt));
  // Of several lights the one with the largest error need not be the one that is uncertain.
  compare::LightFigures wrong = known;
  wrong.error.wrong_fraction = 0.01;
  studies::set_figures({wrong, known}, *compare::find_measure("wrong"), attempt);
  EXPECT_TRUE(is_good(error_goal(0.02), attempt));
  for (const auto& lights : {std::vector{wrong, doubtful}, std::vector{doubtful, wrong}}) {
    studies::set_figures(lights, *compare::find_measure("wrong"), attempt);
    EXPECT_EQ(attempt.error, 0.01);
    EXPECT_FALSE(is_good(error_goal(0.02), attempt));
  }
}

// A family that is left because its error levels off is not good enough at the largest size either.
TEST(Tune, WhatLevelsOffIsNotGoodEnoughAtTheLargestMap) {
  auto scene = load_scene("fence");
  ASSERT_TRUE(scene);
  OneWorld world(*scene);
  studies::Engine engine(world.scene, world.world, *world.renderer, false);
  const Setting base = small_setting(world);
  TuneOptions options;
  options.goal.max_error =
      compare::Threshold{compare::find_measure("wrong"), 0.02};  // hard shadows reach it at the largest size
  options.sizes = {64, 128, 256, 512, 1024, 2048, 4096};
  options.families = {family("hard", Technique::hard), family("hard, front faces", Technique::hard),
                      family("vsm", Technique::vsm)};
  options.families[1].map.cull = raster::Cull::front;
  options.cost = cost;
  const auto tuned = studies::tune(engine, base, options);
  ASSERT_TRUE(tuned) << tuned.error().message();
  std::size_t left = 0;
  for (std::size_t i = 0; i < options.families.size(); ++i) {
    const studies::FamilyResult& result = tuned->families[i];
    if (result.stop != studies::TuneStop::levels_off) continue;
    ++left;
    EXPECT_LT(result.tried.back().size, options.sizes.back());
    TuneOptions largest = options;
    largest.families = {options.families[i]};
    largest.sizes = {options.sizes.back()};
    const auto alone = studies::tune(engine, base, largest);
    ASSERT_TRUE(alone) << alone.error().message();
    std::printf("%-18s levels off near %.4f, at the largest size %.4f\n", result.family.name.c_str(),
                result.floor, alone->families[0].closest.error);
    EXPECT_FALSE(alone->feasible) << result.family.name;
    // The estimate leaves out what sampling still adds at that size.
    EXPECT_NEAR(result.floor, alone->families[0].closest.error, 0.15 * result.floor) << result.family.name;
  }
  EXPECT_GE(left, 1u);
  EXPECT_TRUE(tuned->feasible);
}

}  // namespace
}  // namespace gnomon::test
