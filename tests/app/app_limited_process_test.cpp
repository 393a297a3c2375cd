// A drawing of a student's shader ends by what it does, not by what else the machine does.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

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

/// A program that takes commands of one word (scene/base/many_commands.h), and says its own number on stderr first.
const std::string taker = R"py(
import os, signal, sys, time
word = b""
def spin(seconds):
  end = time.process_time() + seconds
  while time.process_time() < end: pass
while byte := os.read(0, 1):
  if byte != b"\0": word += byte; continue
  if not word: continue
  os.write(2, b"%d " % os.getpid())
  if word == b"works": spin(0.4)
  if word == b"spins": spin(60)
  if word == b"dies": os.kill(os.getpid(), signal.SIGKILL)
  os.write(2, word)
  os.read(0, 1)
  os.write(1, b"\3" if word == b"fails" else b"\0")
  word = b""
)py";

/// The exit code where it exited, the negative number of the signal, and -1000 where the time was over.
int end_of(const Outcome& outcome) {
  if (outcome.end == Outcome::End::out_of_time) return -1000;
  return outcome.end == Outcome::End::killed ? -outcome.code : outcome.code;
}

// What one command does is charged to it alone, and costs the next one nothing.
TEST(CommandProcess, GoesOnBehindTheCommandThatFailed) {
  CommandProcess process("/usr/bin/python3", {"-c", taker}, {.seconds = 1.0});
  int number = 0;
  for (const auto& [word, end, is_new] : {std::tuple{"works", 0, true},
                                          {"works", 0, false},
                                          {"works", 0, false},
                                          {"fails", 3, false},
                                          {"goes on", 0, true},
                                          {"dies", -SIGKILL, false},
                                          {"goes on", 0, true},
                                          {"spins", -1000, false},
                                          {"goes on", 0, true}}) {
    const auto outcome = process.run({word});
    ASSERT_TRUE(outcome) << outcome.error().message();
    EXPECT_EQ(end_of(*outcome), end) << word;
    EXPECT_EQ(outcome->err.ends_with(word), end >= 0) << outcome->err;
    EXPECT_EQ(std::stoi(outcome->err) != std::exchange(number, std::stoi(outcome->err)), is_new) << word;
  }
  kill(number, SIGKILL);
  siginfo_t ended{};
  waitid(P_PID, static_cast<id_t>(number), &ended, WEXITED | WNOWAIT);
  const auto outcome = process.run({"goes on"});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(end_of(*outcome), 0) << "it was ended while it waited";
}

}  // namespace
}  // namespace gnomon::grade
