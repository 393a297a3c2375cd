// Few processes and little memory: the program goes on with fewer threads and says so, or ends with one line.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"
#include "tests/support/places.h"

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

/// An EXR of another renderer's, so that OpenImageIO is loaded, and with it libraries that start threads.
std::string capture_in(const TemporaryFolder& folder) {
  constexpr ImageSize size{64, 36};
  const std::vector<Channel> lit{{"V", std::vector<float>(size.pixels(), 1.0f)}};
  EXPECT_TRUE(write_exr(folder / "v.exr", size, lit));
  write_text(
      folder / "capture.json",
      R"({"schema": "gnomon/capture/1", "renderer": {"name": "x"}, "scene": "thin-wall", "size": [64, 36],
                 "visibility": "v.exr"})");
  return folder / "capture.json";
}

/// What starts threads: oneTBB, the graphics driver, OpenImageIO and what comes with it, the program itself.
std::vector<Words> commands_with_threads(const std::string& capture) {
  return {Words{"compare", "acne-floor", "-o", "out", "--aov", "out/a.exr"} + small,
          {"judge", capture, "-o", "out"},
          {"raytrace", "acne-floor", "--size", "64x36", "-o", "out/x.exr"},
          {"export", "teapot", "-o", "out/x.glb"},
          {"export", "--suite", "out", "--size", "16x9"},
          {"lessons", "--only", "precision", "-o", "out"}};
}

/// Expects what is done without limits, with fewer threads perhaps, or exit code 5 and one line that says why.
void expect_done_or_said(const ProcessResult& result, const ProcessResult& usual, const std::string& what) {
  EXPECT_EQ(result.signal, 0) << what << ": " << result.err;
  if (result.exit_code == usual.exit_code) return;
  EXPECT_EQ(result.exit_code, 5) << what << ": " << result.err;
  EXPECT_NE(result.err.find("a limit on processes"), std::string::npos) << what << ": " << result.err;
}

// Threads that a library starts are tried beforehand; that one is refused nevertheless ends the program in words, wherever it
// is: no abort, no waiting for ever, no internal error.
TEST(FewResources, NoMoreThreadsFromAnyOneOn) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer starts threads of its own";
  const TemporaryFolder given;
  for (const Words& words : commands_with_threads(capture_in(given))) {
    const TemporaryFolder usual_folder;
    const ProcessResult usual = run_gnomon(words, {.folder = usual_folder.path()});
    for (const int first : {1, 4, 8, 10, 11, 12, 14, 15, 16, 17, 18, 20, 22, 24}) {
      const TemporaryFolder folder;
      const ProcessResult result = run_gnomon(
          words, {.folder = folder.path(),
                  .environment = {"LD_PRELOAD=" + test::fault_injector(), "GNOMON_FAULT_CALL=thread",
                                  "GNOMON_FAULT_ONWARD=1", "GNOMON_FAULT_ERROR=11",  // EAGAIN
                                  "GNOMON_FAULT_AT=" + std::to_string(first)}});
      expect_done_or_said(result, usual, words[0] + ", none from " + std::to_string(first));
    }
  }
}

TEST(FewResources, FewProcessesInEveryCommand) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer starts a process of its own";
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to become a user without other processes";
  const TemporaryFolder given;
  const std::string capture = capture_in(given);
  for (const std::string& path : {given.path(), capture, given / "v.exr"})
    std::filesystem::permissions(path, std::filesystem::perms::all);
  for (const Words& words : commands_with_threads(capture)) {
    const TemporaryFolder usual_folder;
    const ProcessResult usual = run_gnomon(words, {.folder = usual_folder.path()});
    for (const int processes : {0, 2, 3, 4, 6, 8}) {
      const TemporaryFolder folder;
      std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
      const ProcessResult result = run_gnomon(words, {.folder = folder.path(), .process_limit = processes});
      if (result.exit_code == 98) GTEST_SKIP() << "another user cannot run the program where it lies";
      expect_done_or_said(result, usual, words[0] + ", " + std::to_string(processes) + " processes");
    }
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

void limit_stack(rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  setrlimit(RLIMIT_STACK, &limit);
}

// As in a container or a shell with ulimit -s: a stack on which no picture can be drawn.
TEST(FewResources, SmallStacks) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer needs more before the program begins";
  const TemporaryFolder given;
  for (const Words& words : commands_with_threads(capture_in(given))) {
    const TemporaryFolder usual_folder;
    const ProcessResult usual = run_gnomon(words, {.folder = usual_folder.path()});
    for (void (*const limit)() :
         {+[] { limit_stack(64 << 10, 64 << 10); }, +[] { limit_stack(200 << 10, RLIM_INFINITY); }}) {
      const TemporaryFolder folder;
      const ProcessResult result = run_gnomon(words, {.folder = folder.path(), .prepare = limit});
      EXPECT_EQ(result.exit_code, usual.exit_code)
          << words[0] << ", signal " << result.signal << ": " << result.err;
      EXPECT_EQ(folder.entries(), usual_folder.entries()) << words[0];
    }
  }
}

}  // namespace
}  // namespace gnomon::app_test
