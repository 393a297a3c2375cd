// What gnomon verify's rows say of what could not be tried: a machine without OpenGL skips a row, and a drawing that
// fails where there is OpenGL is wrong.
#include <gtest/gtest.h>

#include "verify/drawn_world.h"

namespace gnomon::verify {
namespace {

Run run_of(const Options& options) {
  static const Progress none;
  return {43, options, false, none};
}

Scene lit_floor() {
  Scene scene = scene_of({quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.lights = {sun({0, -1, 0})};
  scene.camera.eye = {0.0, 3.0, 1.0};
  return scene;
}

TEST(VerifyRays, AreAtLeast256AndNeverMoreThanTheMost) {
  const auto run = run_of({.rays = 10'000});
  EXPECT_EQ(run.rays(1e-4, 64), 64u);
  EXPECT_EQ(run.rays(1e-4), 256u);
  EXPECT_EQ(run.rays(0.5), 5000u);
  EXPECT_EQ(run.rays(1.0, 2000), 2000u);
}

TEST(VerifyRows, WhatCouldNotBeTriedIsWrong) {
  auto run = run_of({});
  run.fault("a drawing", "why it failed");
  const std::vector<Row> rows = run.take_rows();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].name, "a drawing: why it failed");
  EXPECT_EQ(rows[0].outcome.wrong, 1u);
  EXPECT_TRUE(rows[0].skipped.empty());
  EXPECT_FALSE(rows[0].ok());
}

TEST(VerifyRows, OnlyAMachineWithoutAContextSkips) {
  DrawnWorld drawn(lit_floor());
  auto run = run_of({});
  add_row_of_undrawn(run, drawn, "a drawing");
  const std::vector<Row> rows = run.take_rows();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].ok(), !drawn.has_context()) << rows[0].skipped;
  EXPECT_EQ(drawn.draw(drawing({16, 16}, 64, 0.0)).has_value(), drawn.ready());
}

}  // namespace
}  // namespace gnomon::verify
