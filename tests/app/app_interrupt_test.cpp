// A signal never cuts an output: it waits until the guard is gone, and the exit code then says that it came.
#include "app/process/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "tests/support/app_process.h"

namespace gnomon::app {
namespace {

/// The exit code of a process that does `work` (or -1).
int exit_code_of(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);
    work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void wait_for_the_end() {
  std::this_thread::sleep_for(std::chrono::seconds(60));
}

TEST(Interrupt, EndsTheProcessWith130) {
  EXPECT_EQ(exit_code_of([] {
              watch_for_interrupts();
              kill(getpid(), SIGINT);
              wait_for_the_end();
            }),
            130);
}

TEST(Interrupt, WaitsForTheOutputs) {
  const app_test::TemporaryFolder folder;
  EXPECT_EQ(exit_code_of([&] {
              watch_for_interrupts();
              {
                const OutputGuard guard;
                kill(getpid(), SIGINT);
                while (interrupt_exit_code() == 0) std::this_thread::yield();
                app_test::write_text(folder / "whole", "all of it");
              }
              wait_for_the_end();
            }),
            130);
  EXPECT_EQ(app_test::read_file(folder / "whole"), "all of it");
}

TEST(Interrupt, RemovesTemporaryFolders) {
  const app_test::TemporaryFolder folder;
  EXPECT_EQ(exit_code_of([&] {
              watch_for_interrupts();
              const TemporaryFolder temporary("gnomon-interrupt-test");
              app_test::write_text(temporary.path() + "/drawing", "of a student");
              app_test::write_text(folder / "path", temporary.path());
              kill(getpid(), SIGTERM);
              wait_for_the_end();
            }),
            143);
  const std::string path = app_test::read_file(folder / "path");
  EXPECT_NE(path.find("gnomon-interrupt-test-"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Interrupt, ATemporaryFolderGoesWithWhatIsInIt) {
  std::string path;
  {
    const TemporaryFolder temporary("gnomon-interrupt-test");
    path = temporary.path();
    app_test::write_text(path + "/drawing", "of a student");
    EXPECT_TRUE(std::filesystem::exists(path + "/drawing"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Interrupt, ItsExitCodeIsKnownWhileTheOutputsAreFinished) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const int code = exit_code_of([&] {
      watch_for_interrupts();
      const OutputGuard guard;
      kill(getpid(), signal_number);
      while (interrupt_exit_code() == 0) std::this_thread::yield();
      _exit(interrupt_exit_code() - 100);
    });
    EXPECT_EQ(code, 28 + signal_number);
  }
}

TEST(Interrupt, AnIgnoredSignalStaysIgnored) {
  EXPECT_EQ(exit_code_of([] {
              signal(SIGINT, SIG_IGN);
              watch_for_interrupts();
              kill(getpid(), SIGINT);
            }),
            0);
}

}  // namespace
}  // namespace gnomon::app
