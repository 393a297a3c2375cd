// Folders of outputs when the system fails, or the process is killed, at any of its steps. This program has its own
// renameat(), linkat(), mkdirat(), fsync() and unlinkat(), which the libraries call, too; each can be told to fail or to end
// the process.
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
  int at = 0, count = 0, error = EIO;
} plan;

int looks = 0;  ///< calls of stat() and fstatat()

/// Whether this call is to fail.
bool strikes(const char* call) {
  if (plan.fault == Fault::none || (!plan.call.empty() && plan.call != call)) return false;
  ++plan.count;
  const bool now = plan.count == plan.at || (plan.fault == Fault::stays_broken && plan.count > plan.at);
  if (now && plan.fault == Fault::kills) ::kill(::getpid(), SIGKILL);
  if (now) errno = plan.error;
  return now;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {
int renameat(int from_folder, const char* from, int folder, const char* to) noexcept {
  using Rename = int (*)(int, const char*, int, const char*);
  return strikes("rename") ? -1 : real<Rename>("renameat")(from_folder, from, folder, to);
}
int linkat(int from_folder, const char* from, int folder, const char* to, int flags) noexcept {
  using Link = int (*)(int, const char*, int, const char*, int);
  return strikes("link") ? -1 : real<Link>("linkat")(from_folder, from, folder, to, flags);
}
int mkdirat(int folder, const char* path, mode_t mode) noexcept {
  return strikes("mkdir") ? -1 : real<int (*)(int, const char*, mode_t)>("mkdirat")(folder, path, mode);
}
int fsync(int) {  // these tests cut no power
  return strikes("fsync") ? -1 : 0;
}
int stat(const char* path, struct stat* status) noexcept {
  ++looks;
  return real<int (*)(const char*, struct stat*)>("stat")(path, status);
}
int fstatat(int folder, const char* path, struct stat* status, int flags) noexcept {
  ++looks;
  using Look = int (*)(int, const char*, struct stat*, int);
  return real<Look>("fstatat")(folder, path, status, flags);
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
    plan = {fault, call, at};
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

/// The older files by their names, wherever in the folder they lie.
std::map<std::string, std::string> older_wherever(const Contents& all) {
  std::map<std::string, std::string> found;
  for (const std::string& name : older_files)
    for (const auto& [path, content] : all)
      if (content == "older " + name) found[name] = path;
  return found;
}

// What cannot be put back at once is kept, until a whole new result is there.
TEST(OutputFaults, ADiskThatStaysBrokenLosesNothing) {
  for (const char* call : {"rename", ""})
    for_each_fault(
        Fault::stays_broken, call, true,
        [&](const TemporaryFolder& folder, const Contents& before, const Expected<void>& published) {
          const Contents left = contents(folder.path());
          const bool whole = without_staged(left) == before;
          if (!whole && !published) {
            const std::string& why = published.error().reason;
            EXPECT_TRUE(why.find("put back") != std::string::npos ||
                        why.find("in their places") != std::string::npos)
                << why;
          }
          if (published || published.error().reason.find("in their places") != std::string::npos) return;
          ASSERT_TRUE(StagedFolder::open(folder.file("out")));
          EXPECT_EQ(older_wherever(contents(folder.path())).size(), older_files.size())
              << published.error().message();
          ASSERT_TRUE(publish_newer(folder.file("out")));
          EXPECT_EQ(contents(folder.path()), newer_contents());
        });
}

/// A child that is killed at a call; false: it came through.
bool is_killed_at(int at, const std::string& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    plan = {Fault::kills, "", at};
    ::_exit(publish_newer(folder) ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
  return WIFSIGNALED(status);
}

TEST(OutputFaults, AKilledProcessLeavesNoMixtureWithAPage) {
  const Contents newer = newer_contents();
  int mixed = 0;
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    write_older(folder);
    const Contents before = contents(folder.path());
    SCOPED_TRACE(at);
    if (!is_killed_at(at, folder.file("out"))) break;
    const Contents left = without_staged(contents(folder.path()));
    if (left != before && left != newer) {
      EXPECT_FALSE(left.contains("out/page"));
      ++mixed;
    }
    EXPECT_EQ(left.at("out/of-the-older-alone"), "older of-the-older-alone");
    EXPECT_EQ(left.at("out/mine.part"), "older mine.part");
    ASSERT_TRUE(publish_newer(folder.file("out")));
    EXPECT_EQ(contents(folder.path()), newer);
  }
  EXPECT_GT(mixed, 5) << "kills in the middle";
}

// A staged folder from somebody else is no list of what to move: it goes, and nothing of it is used.
TEST(OutputFaults, APlantedFolderMovesNothing) {
  const TemporaryFolder folder;
  write_older(folder);
  for (const char* name : {"out/.gnomon.1.part", "out.gnomon.2.part"}) {
    const std::string staged = name;
    folder.put(staged + "/.publishing", std::string("7 7 ../outside\0"
                                                    "7 7 l/outside\0",
                                                    30));
    folder.put(staged + "/.replaced/l/outside", "planted");
    folder.put(staged + "/.replaced/page", "planted");
    folder.put(staged + "/outside", "planted");
  }
  fs::create_symlink("..", folder.file("out/l"));
  ASSERT_TRUE(publish_newer(folder.file("out")));
  Contents expected = newer_contents();
  expected["out/l"] = "a folder";
  EXPECT_EQ(contents(folder.path()), expected);
  EXPECT_TRUE(StagedFolder::left_alone().empty());
}

// Neither what they lead to nor what they are is touched, and one sentence names them.
TEST(OutputFaults, WhatIsNoStagedFolderOfTheUsersIsLeftAndSaid) {
  const TemporaryFolder folder;
  write_older(folder);
  folder.put("outside/a", "mine");
  folder.put("out/.gnomon.1.part", "a file");
  fs::create_directory_symlink(folder.file("outside"), folder.file("out/.gnomon.2.part"));
  fs::create_symlink("nowhere", folder.file("out/.gnomon.3.part"));
  ASSERT_EQ(::mkfifo(folder.file("out.gnomon.4.part").c_str(), 0600), 0);
  std::size_t refused = 4;
  if (::geteuid() == 0) {
    folder.put("out/.gnomon.5.part/a", "another's");
    ASSERT_EQ(::chown(folder.file("out/.gnomon.5.part").c_str(), 65534, 65534), 0);
    folder.put("out/.gnomon.6.part/below/a", "another's");
    ASSERT_EQ(::chown(folder.file("out/.gnomon.6.part/below/a").c_str(), 65534, 65534), 0);
    refused = 6;
  }
  ASSERT_TRUE(StagedFolder::open(folder.file("out")));
  EXPECT_EQ(StagedFolder::left_alone().size(), refused);
  EXPECT_TRUE(StagedFolder::left_alone().empty());
  EXPECT_EQ(test::bytes_of(folder.file("outside/a")), "mine");
  EXPECT_EQ(test::bytes_of(folder.file("out/.gnomon.1.part")), "a file");
  for (const char* name : {"out/.gnomon.2.part", "out/.gnomon.3.part"})
    EXPECT_TRUE(fs::is_symlink(folder.file(name))) << name;
  EXPECT_TRUE(fs::is_fifo(folder.file("out.gnomon.4.part")));
  if (refused == 6) {
    EXPECT_EQ(test::bytes_of(folder.file("out/.gnomon.5.part/a")), "another's");
    EXPECT_EQ(test::bytes_of(folder.file("out/.gnomon.6.part/below/a")), "another's");
  }
}

// Abandoned folders go with the links in them, which lead out to what stays.
TEST(OutputFaults, RemovingFollowsNoLink) {
  const TemporaryFolder folder;
  write_older(folder);
  folder.put("outside/a", "mine");
  folder.put("out/.gnomon.1.part/a", "abandoned");
  fs::create_directory_symlink(folder.file("outside"), folder.file("out/.gnomon.1.part/l"));
  ASSERT_TRUE(StagedFolder::open(folder.file("out")));
  EXPECT_FALSE(fs::exists(folder.file("out/.gnomon.1.part")));
  EXPECT_EQ(test::bytes_of(folder.file("outside/a")), "mine");
}

// The process's own number is no secret.
TEST(OutputFaults, AStagedNameThatIsTakenGetsAnother) {
  const TemporaryFolder folder;
  write_older(folder);
  folder.put("outside/a", "mine");
  fs::create_directory_symlink(folder.file("outside"),
                               folder.file("out/.gnomon." + std::to_string(::getpid()) + ".part"));
  ASSERT_TRUE(publish_newer(folder.file("out")));
  EXPECT_EQ(test::bytes_of(folder.file("out/page")), "newer page");
  EXPECT_EQ(test::bytes_of(folder.file("outside/a")), "mine");
  EXPECT_EQ(StagedFolder::left_alone().size(), 1u) << "once, though it was met twice";
}

TEST(OutputFaults, ALinkInTheFolderIsNotWrittenThrough) {
  for (const char* way : {"cells", "more", "more/deep"}) {
    const TemporaryFolder folder;
    folder.put("out/a", "older a");
    folder.put("outside/1", "mine");
    fs::create_directories(
        folder.file(std::string("out/") + way).substr(0, folder.file(std::string("out/") + way).rfind('/')));
    fs::create_directory_symlink(folder.file("outside"), folder.file(std::string("out/") + way));
    const Contents before = contents(folder.path());
    const auto published = publish_newer(folder.file("out"));
    ASSERT_FALSE(published) << way;
    EXPECT_EQ(published.error().kind, ErrorKind::cannot_write);
    EXPECT_NE(published.error().message().find("is a link"), std::string::npos)
        << published.error().message();
    EXPECT_EQ(contents(folder.path()), before) << way;
  }
}

// A file that is a link is replaced itself; the folder, which its user named, may be one.
TEST(OutputFaults, AFileThatIsALinkIsReplaced) {
  const TemporaryFolder folder;
  folder.put("outside", "mine");
  folder.put("real/a", "older a");
  fs::create_symlink(folder.file("outside"), folder.file("real/page"));
  fs::create_directory_symlink("real", folder.file("out"));
  ASSERT_TRUE(publish_newer(folder.file("out")));
  EXPECT_EQ(test::bytes_of(folder.file("outside")), "mine");
  EXPECT_EQ(test::bytes_of(folder.file("real/page")), "newer page");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder.file("real/page"))));
  EXPECT_TRUE(fs::is_symlink(folder.file("out")));
}

// A signal that comes while the disk is waited for is no fault of the disk.
TEST(OutputFaults, AnInterruptedCallIsMadeAgain) {
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    write_older(folder);
    plan = {Fault::fails, "fsync", at, 0, EINTR};
    const auto published = publish_newer(folder.file("out"));
    const bool struck = plan.count >= plan.at;
    plan = {};
    ASSERT_TRUE(published) << at << ": " << published.error().message();
    if (!struck) break;
  }
}

/// Two folders of one run, published together.
Expected<void> publish_both(const std::string& one, const std::string& other) {
  auto first = StagedFolder::open(one), second = StagedFolder::open(other);
  for (auto* staged : {&first, &second}) {
    if (!*staged) return fail(staged->error());
    for (const char* name : {"a", "page"})
      if (auto written = write_file((*staged)->path() + "/" + name, "newer"); !written) return written;
    if (auto sealed = (*staged)->seal({}); !sealed) return sealed;
  }
  const StagedFolder::Part parts[] = {{&*first, ""}, {&*second, "page"}};
  return StagedFolder::publish(parts);
}

TEST(OutputFaults, SeveralFoldersAppearTogetherOrNotAtAll) {
  for (const char* call : {"rename", "mkdir", "link", "fsync"})
    for (int at = 1;; ++at) {
      const TemporaryFolder folder;
      for (const char* name : {"one/a", "two/a", "two/page"}) folder.put(name, "older");
      const Contents before = contents(folder.path());
      plan = {Fault::fails, call, at};
      const auto published = publish_both(folder.file("one"), folder.file("two"));
      const bool struck = plan.count >= plan.at;
      plan = {};
      SCOPED_TRACE(std::string(call) + " " + std::to_string(at));
      if (!published) {
        EXPECT_EQ(contents(folder.path()), before);
      }
      if (!struck) break;
    }
}

TEST(OutputFaults, TheLastFileMayLieInANewFolder) {
  const TemporaryFolder folder;
  write_older(folder);
  auto staged = StagedFolder::open(folder.file("out"));
  ASSERT_TRUE(staged);
  ASSERT_TRUE(make_output_folder(staged->path() + "/deep/er"));
  for (const char* name : {"/a", "/deep/er/page"}) ASSERT_TRUE(write_file(staged->path() + name, "newer"));
  ASSERT_TRUE(staged->seal({}));
  const auto published = staged->publish("deep/er/page");
  ASSERT_TRUE(published) << published.error().message();
  EXPECT_EQ(test::bytes_of(folder.file("out/deep/er/page")), "newer");
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
    plan = {Fault::fails, "", -1};
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
