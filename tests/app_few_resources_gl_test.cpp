// Few processes and little memory: the program goes on with fewer threads and says so, or ends with one line.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "tests/app_process.h"
#include "tests/support/sanitizer.h"

namespace gnomon::app_test {
namespace {

// The limit counts the threads of a user who must not be root, and the program has at least two.
TEST(FewResources, FewProcesses) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer starts a process of its own";
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to become a user without other processes";
  for (const int processes : {1, 2, 4, 5, 8}) {
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
    const ProcessResult result = run_gnomon(Words{"compare", "acne-floor", "-o", "out"} + small,
                                            {.folder = folder.path(), .process_limit = processes});
    if (result.exit_code == 98) GTEST_SKIP() << "another user cannot run the program where it lies";
    EXPECT_EQ(result.exit_code, processes > 2 ? 0 : 5) << processes << ": " << result.err;
    const bool noted = result.err.find("threads can be started") != std::string::npos ||
                       result.err.find("not one thread can be started") != std::string::npos;
    const bool too_few = processes <= 2 || (processes < 6 && std::thread::hardware_concurrency() > 1);
    EXPECT_TRUE(noted || !too_few) << processes << ": " << result.err;
  }
}

TEST(FewResources, LittleAddressSpace) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer reserves more";
  const TemporaryFolder folder;
  for (const long megabytes : {200, 280, 360, 440, 520}) {
    const ProcessResult result = run_gnomon(Words{"compare", "acne-floor", "-o", "out", "-q"} + small,
                                            {.folder = folder.path(), .address_limit = megabytes << 20});
    EXPECT_EQ(result.exit_code, 5) << megabytes << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(folder.entries().empty());
  }
}

}  // namespace
}  // namespace gnomon::app_test
