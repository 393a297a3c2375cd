// Programs that this one starts: their codes, and that signals reach them though this one's threads block some.
#include <gtest/gtest.h>
#include <signal.h>

#include "scene/run_program.h"

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

}  // namespace
}  // namespace gnomon
