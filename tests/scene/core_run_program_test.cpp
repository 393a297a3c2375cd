// Programs that this one starts: their codes, and that signals reach them though this one's threads block some.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "scene/base/run_program.h"

#include "scene/base/interruptible.h"

namespace gnomon {
namespace {

TEST(RunProgram, TellsHowItEnded) {
  EXPECT_EQ(run_program({"true"}).value(), 0);
  EXPECT_EQ(run_program({"sh", "-c", "exit 3"}).value(), 3);
  EXPECT_EQ(run_program({"sh", "-c", "kill -KILL $$"}).value(), 128 + SIGKILL);
  const auto none = run_program({"gnomon-no-such-program"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message(), "gnomon-no-such-program cannot be started: No such file or directory");
}

TEST(RunProgram, SignalsReachIt) {
  sigset_t terminate, before;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &terminate, &before);
  EXPECT_EQ(run_program({"sh", "-c", "kill -TERM $$; exit 0"}).value(), 128 + SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

/// Whether the process is there and no zombie, whom nobody may have taken yet.
bool runs(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:")) return line.find('Z') == std::string::npos;
  return false;
}

// With what it has started itself, though it will not end when it is asked to.
TEST(RunProgram, EndsWhatTakesTooLong) {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  const auto ended = run_program(
      {"sh", "-c", "trap '' TERM; sh -c 'echo $$; exec sleep 1000' >" + note + " & wait; sleep 1000"}, 0.5);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().kind, ErrorKind::graphics);
  EXPECT_EQ(ended.error().message(), "sh did not end within 0.5 s, and was ended");
  std::string child;
  std::getline(std::ifstream(note), child);
  EXPECT_FALSE(runs(child)) << child;
  std::filesystem::remove(note);
}

TEST(RunProgram, EndsWhatIsWaitedForInVain) {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  const Interruptible work([&] { return std::filesystem::exists(note); });
  const auto ended =
      run_program({"sh", "-c", "echo $$ >" + note + ".part; mv " + note + ".part " + note + "; sleep 1000"});
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().message(), "sh was ended");
  std::filesystem::remove(note);
}

/// Whether a program that ignores signals is gone once end_programs() has returned, and none is started after it.
bool no_program_outlives_the_end() {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  std::thread waits([&] {
    run_program({"sh", "-c",
                 "trap '' TERM; echo $$ >" + note + ".part; mv " + note + ".part " + note +
                     "; sleep 1000; sleep 1000"});
  });
  while (!std::filesystem::exists(note)) std::this_thread::yield();
  end_programs();
  std::string child;
  std::getline(std::ifstream(note), child);
  const bool ended = !runs(child), none = !run_program({"true"});
  waits.join();
  std::filesystem::remove(note);
  return ended && none;
}

// In a process of its own, which it leaves without programs for good.
TEST(RunProgram, EndsWhenTheProcessEnds) {
  EXPECT_EXIT(exit(no_program_outlives_the_end() ? 7 : 0), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace gnomon
