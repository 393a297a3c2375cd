// A drawing of a student's shader ends by what it does, not by what else the machine does.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>

#include "grade/limited_process.h"
#include "scene/files/own_program.h"

namespace gnomon::grade {
namespace {

/// This test program itself as the child: one of the cases below that are disabled otherwise.
Outcome run_child(const std::string& name, const Limits& limits) {
  const auto outcome = run_limited(
      own_program().string(),
      {"--gtest_also_run_disabled_tests", "--gtest_filter=LimitedProcessChild.DISABLED_" + name}, limits);
  EXPECT_TRUE(outcome) << outcome.error().message();
  return outcome.value_or(Outcome{});
}

TEST(LimitedProcessChild, DISABLED_Sleeps) {
  sleep(3);
}
TEST(LimitedProcessChild, DISABLED_SleepsForLong) {
  sleep(60);
}
TEST(LimitedProcessChild, DISABLED_Spins) {
  for (volatile unsigned i = 0;;) i = i + 1;
}
TEST(LimitedProcessChild, DISABLED_SpinsInAThread) {
  std::thread([] {
    for (volatile unsigned i = 0;;) i = i + 1;
  }).join();
}
TEST(LimitedProcessChild, DISABLED_Complains) {
  std::fputs("one\n", stderr);
  std::fputs("two\n", stderr);
  _exit(3);
}
TEST(LimitedProcessChild, DISABLED_IsKilled) {
  raise(SIGKILL);
}

TEST(LimitedProcess, WaitingTakesNothingOfTheTime) {
  EXPECT_EQ(run_child("Sleeps", {.seconds = 2.0}).end, Outcome::End::exited);
}

TEST(LimitedProcess, TheTimeOfEveryThreadCounts) {
  EXPECT_EQ(run_child("Spins", {.seconds = 1.0}).end, Outcome::End::out_of_time);
  EXPECT_EQ(run_child("SpinsInAThread", {.seconds = 1.0}).end, Outcome::End::out_of_time);
}

TEST(LimitedProcess, WhatDoesNothingIsGivenUpAndNotCalledSlow) {
  EXPECT_EQ(run_child("SleepsForLong", {.idle_seconds = 2.0}).end, Outcome::End::stalled);
}

TEST(LimitedProcess, ItsLastWordsAndItsEndAreKept) {
  const Outcome outcome = run_child("Complains", {});
  EXPECT_EQ(outcome.end, Outcome::End::exited);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "one\ntwo\n");
  const Outcome killed = run_child("IsKilled", {});
  EXPECT_EQ(killed.end, Outcome::End::killed);
  EXPECT_EQ(killed.code, SIGKILL);
}

}  // namespace
}  // namespace gnomon::grade
