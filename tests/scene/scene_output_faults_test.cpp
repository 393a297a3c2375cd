// Folders of outputs when the system fails, or the process is killed, at any of its steps. This program has its own rename(),
// link(), mkdir(), fsync() and unlinkat(), which the libraries call, too; each can be told to fail or to end the process.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <optional>

#include "scene/files/path_status.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "tests/support/scene_files_support.h"

namespace {

enum class Fault { none, fails, stays_broken, kills };

/// The call that fails: the `at`-th, from 1, of those of one name or of all.
struct Plan {
  Fault fault = Fault::none;
  std::string call;
  int at = 0, count = 0;
} plan;

int looks = 0;  ///< calls of stat() and lstat()

/// Whether this call is to fail.
bool strikes(const char* call) {
  if (plan.fault == Fault::none || (!plan.call.empty() && plan.call != call)) return false;
  ++plan.count;
  const bool now = plan.count == plan.at || (plan.fault == Fault::stays_broken && plan.count > plan.at);
  if (now && plan.fault == Fault::kills) ::kill(::getpid(), SIGKILL);
  if (now) errno = EIO;
  return now;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {
int rename(const char* from, const char* to) noexcept {
  return strikes("rename") ? -1 : real<int (*)(const char*, const char*)>("rename")(from, to);
}
int link(const char* from, const char* to) noexcept {
  return strikes("link") ? -1 : real<int (*)(const char*, const char*)>("link")(from, to);
}
int mkdir(const char* path, mode_t mode) noexcept {
  return strikes("mkdir") ? -1 : real<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}
int fsync(int) {  // these tests cut no power
  return strikes("fsync") ? -1 : 0;
}
int stat(const char* path, struct stat* status) noexcept {
  ++looks;
  return real<int (*)(const char*, struct stat*)>("stat")(path, status);
}
int lstat(const char* path, struct stat* status) noexcept {
  ++looks;
  return real<int (*)(const char*, struct stat*)>("lstat")(path, status);
}
int unlinkat(int folder, const char* path, int flags) noexcept {
  return strikes("unlinkat") ? -1 : real<int (*)(int, const char*, int)>("unlinkat")(folder, path, flags);
}
}

namespace gnomon {
namespace {

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;

Contents contents(const std::string& folder) {
  Contents found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    found[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? test::bytes_of(entry.path().string()) : "a folder";
  return found;
}

const std::vector<std::string> older_files{"page", "a", "cells/1", "of-the-older-alone", "mine.part"},
    newer_files{"page", "a", "b", "cells/1", "cells/2", "more/deep/3"};

void write_older(const TemporaryFolder& folder) {
  for (const std::string& name : older_files) folder.put("out/" + name, "older " + name);
}

Expected<void> publish_newer(const std::string& folder) {
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const std::string& name : newer_files) {
    const std::string path = staged->path() + "/" + name;
    if (auto made = make_output_folder(fs::path(path).parent_path().string()); !made) return made;
    if (auto written = write_file(path, "newer " + name); !written) return written;
  }
  if (auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish("page");
}

/// What lies in the folder after a run without faults.
Contents newer_contents() {
  const TemporaryFolder folder;
  write_older(folder);
  EXPECT_TRUE(publish_newer(folder.file("out")));
  return contents(folder.path());
}

/// Without what a killed process left for the next to clear.
Contents without_staged(Contents all) {
  std::erase_if(all, [](const auto& file) { return file.first.find("gnomon.") != std::string::npos; });
  return all;
}

/// Runs once with each call failing, until a run meets no fault.
template <class Check>
void for_each_fault(Fault fault, const std::string& call, bool older, const Check& check) {
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    if (older) write_older(folder);
    const Contents before = contents(folder.path());
    SCOPED_TRACE(call + " " + std::to_string(at));
    plan = {fault, call, at, 0};
    const auto published = publish_newer(folder.file("out"));
    const bool struck = plan.count >= plan.at;
    plan = {};
    if (!struck) {
      EXPECT_TRUE(published);
      EXPECT_GT(at, 1) << "no such call";
      return;
    }
    check(folder, before, published);
  }
}

const std::vector<std::string> calls{"rename", "mkdir", "fsync", "link", "unlinkat"};

TEST(OutputFaults, AnOlderResultIsPutBackWhole) {
  const Contents newer = newer_contents();
  for (const std::string& call : calls)
    for_each_fault(
        Fault::fails, call, true,
        [&](const TemporaryFolder& folder, const Contents& before, const Expected<void>& published) {
          EXPECT_EQ(contents(folder.path()), published ? newer : before);
          if (!published) {
            EXPECT_EQ(published.error().kind, ErrorKind::cannot_write);
          }
        });
}

TEST(OutputFaults, ANewResultIsThereWholeOrNotAtAll) {
  for (const std::string& call : {std::string("rename"), std::string("mkdir"), std::string("fsync")})
    for_each_fault(Fault::fails, call, false,
                   [&](const TemporaryFolder& folder, const Contents&, const Expected<void>& published) {
                     EXPECT_FALSE(published);
                     EXPECT_EQ(folder.file_count(), 0u);
                   });
}

// What cannot be put back at once is kept, and the next run puts it back before it does anything else.
TEST(OutputFaults, ADiskThatStaysBrokenLosesNothing) {
  for (const char* call : {"rename", ""})
    for_each_fault(
        Fault::stays_broken, call, true,
        [&](const TemporaryFolder& folder, const Contents& before, const Expected<void>& published) {
          const bool whole = without_staged(contents(folder.path())) == before;
          if (!whole && !published) {
            const std::string& why = published.error().reason;
            EXPECT_TRUE(why.find("put back") != std::string::npos ||
                        why.find("in their places") != std::string::npos)
                << why;
          }
          if (published || published.error().reason.find("in their places") != std::string::npos) return;
          ASSERT_TRUE(StagedFolder::open(folder.file("out")));
          EXPECT_EQ(contents(folder.path()), before) << published.error().message();
        });
}

/// A child that is killed at a call; false: it came through.
bool is_killed_at(int at, const std::string& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    plan = {Fault::kills, "", at, 0};
    ::_exit(publish_newer(folder) ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
  return WIFSIGNALED(status);
}

TEST(OutputFaults, AKilledProcessLeavesNoMixtureWithAPage) {
  const Contents newer = newer_contents();
  int undone = 0;
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    write_older(folder);
    const Contents before = contents(folder.path());
    SCOPED_TRACE(at);
    if (!is_killed_at(at, folder.file("out"))) break;
    const Contents left = without_staged(contents(folder.path()));
    const bool mixed = left != before && left != newer;
    if (mixed) {
      EXPECT_FALSE(left.contains("out/page"));
    }
    undone += mixed ? 1 : 0;
    ASSERT_TRUE(StagedFolder::open(folder.file("out")));
    EXPECT_EQ(contents(folder.path()), left == newer ? newer : before);
  }
  EXPECT_GT(undone, 5) << "kills in the middle";
}

// A file that its owner puts in the place of one of the killed process's is not taken away again.
TEST(OutputFaults, WhatSomebodyWroteSinceTheKillStays) {
  int tried = 0;
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    write_older(folder);
    if (!is_killed_at(at, folder.file("out"))) break;
    if (fs::exists(folder.file("out/page"))) continue;
    ++tried;
    folder.put("mine", "mine");
    fs::rename(folder.file("mine"), folder.file("out/a"));
    folder.put("mine", "mine");
    fs::rename(folder.file("mine"), folder.file("out/b"));
    ASSERT_TRUE(StagedFolder::open(folder.file("out")));
    EXPECT_EQ(test::bytes_of(folder.file("out/a")), "mine");
    EXPECT_EQ(test::bytes_of(folder.file("out/b")), "mine");
    EXPECT_EQ(test::bytes_of(folder.file("out/page")), "older page");
  }
  EXPECT_GT(tried, 5);
}

// Undoing can be killed, too.
TEST(OutputFaults, AKillWhileUndoingLosesNothing) {
  int tried = 0;
  for (int at = 1, again = 1;; again = again % 24 + 1) {
    const TemporaryFolder folder;
    write_older(folder);
    const Contents before = contents(folder.path());
    SCOPED_TRACE(std::to_string(at) + " and " + std::to_string(again));
    if (!is_killed_at(at, folder.file("out"))) break;
    const bool undoes = !fs::exists(folder.file("out/page"));
    if (undoes) {
      ++tried;
      is_killed_at(again, folder.file("out"));
      const Contents left = without_staged(contents(folder.path()));
      if (test::bytes_of(folder.file("out/page")) == "older page") {
        EXPECT_EQ(left, before);
      }
      ASSERT_TRUE(StagedFolder::open(folder.file("out")));
      EXPECT_EQ(contents(folder.path()), before);
    }
    if (!undoes || again == 24) at += 4, again = 0;
  }
  EXPECT_GT(tried, 24);
}

// Folders of other people whose names are like those of the program's own.
TEST(OutputFaults, FoldersOfOthersAreNotTakenForAbandonedOnes) {
  const TemporaryFolder folder;
  const std::vector<std::string> theirs{
      "out.2024.part/a",        "out.part/a",    "out.gnomon.x.part/a", "out.gnomon..part/a",
      "out/.gnomon.12.parts/a", "out/12.part/a", "out/.gnomon.part/a"};
  for (const std::string& name : theirs) folder.put(name, "mine");
  ASSERT_TRUE(publish_newer(folder.file("out")));
  ASSERT_TRUE(publish_newer(folder.file("out")));
  for (const std::string& name : theirs) EXPECT_EQ(test::bytes_of(folder.file(name)), "mine") << name;
}

// What is in the way is found before anything moves, or else everything is put back.
TEST(OutputFaults, WhatIsInTheWayStays) {
  for (const char* way : {"out/b/in the way", "out/more", "out/page/in the way"}) {
    const TemporaryFolder folder;
    folder.put("out/a", "older a");
    auto staged = StagedFolder::open(folder.file("out"));
    ASSERT_TRUE(staged);
    fs::create_directories(staged->path() + "/more");
    for (const char* name : {"/a", "/b", "/more/c", "/page"})
      ASSERT_TRUE(write_file(staged->path() + name, "newer"));
    ASSERT_TRUE(staged->seal({}));
    folder.put(way, "older");
    const auto published = staged->publish("page");
    ASSERT_FALSE(published) << way;
    EXPECT_EQ(published.error().kind, ErrorKind::cannot_write);
    EXPECT_EQ(test::bytes_of(folder.file("out/a")), "older a") << way;
    EXPECT_EQ(test::bytes_of(folder.file(way)), "older") << way;
  }
}

// Hundreds of files, and as many inputs that must not be lost: calls to the system stand for the time.
TEST(OutputFaults, WorkGrowsWithTheNumberOfFilesAndNotWithItsSquare) {
  const auto calls_of = [](int files) {
    const TemporaryFolder folder;
    std::vector<std::string> inputs;
    for (int i = 0; i < files; ++i) {
      folder.put("out/" + std::to_string(i), "older");
      inputs.push_back(folder.put("in/" + std::to_string(i), "x"));
    }
    auto staged = StagedFolder::open(folder.file("out"));
    EXPECT_TRUE(staged);
    for (int i = 0; i < files; ++i) std::ofstream(staged->path() + "/" + std::to_string(i)) << i;
    looks = 0;
    plan = {Fault::fails, "", -1, 0};
    EXPECT_TRUE(staged->seal(inputs));
    EXPECT_TRUE(staged->publish("0"));
    const int count = plan.count + looks;
    plan = {};
    return count;
  };
  const int few = calls_of(20), many = calls_of(200);
  EXPECT_LT(many, 11 * few) << few;
}

}  // namespace
}  // namespace gnomon
