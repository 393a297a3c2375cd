// The program starts itself once more with large pages where the system gives them to those who ask.
#include "app/process/machine.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/places.h"

namespace gnomon::app {
namespace {

TEST(LargePages, AreAskedForWhereTheSystemWaitsForIt) {
  EXPECT_TRUE(are_asked_for("always [madvise] never"));
  EXPECT_FALSE(are_asked_for("[always] madvise never"));
  EXPECT_FALSE(are_asked_for("always madvise [never]"));
  EXPECT_FALSE(are_asked_for(""));
}

/// The exit code of a process that starts this test program again by way of start_with_large_pages(), to run `test` alone;
/// 77 where it comes back.
int started_anew(const char* test, const char* tunables) {
  const pid_t child = fork();
  if (child == 0) {
    if (tunables != nullptr)
      setenv("GLIBC_TUNABLES", tunables, 1);
    else
      unsetenv("GLIBC_TUNABLES");
    setenv("GNOMON_STARTED_ANEW", "1", 1);
    std::string name = "app_test", filter = std::string("--gtest_filter=") + test;
    char* words[] = {name.data(), filter.data(), nullptr};
    start_with_large_pages(words);
    _exit(77);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(LargePages, TheNewProcessHasTheTunable) {
  if (std::getenv("GNOMON_STARTED_ANEW") != nullptr) {
    ASSERT_NE(std::getenv("GLIBC_TUNABLES"), nullptr);
    EXPECT_STREQ(std::getenv("GLIBC_TUNABLES"), "glibc.malloc.hugetlb=1");
    return;
  }
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer has its own allocator";
  std::string choices;
  std::getline(std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"), choices);
  const int code = started_anew("LargePages.TheNewProcessHasTheTunable", nullptr);
  EXPECT_EQ(code, are_asked_for(choices) ? 0 : 77) << choices;
}

TEST(LargePages, TheUsersTunablesStay) {
  EXPECT_EQ(started_anew("LargePages.*", "glibc.malloc.check=0"), 77);
}

}  // namespace
}  // namespace gnomon::app
