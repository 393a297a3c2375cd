// Outputs are whole or not at all: full disks, size limits, folders that cannot be written.
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "scene/files/unfinished_files.h"
#include "scene/files/write_file.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

TEST(WriteFile, WritesAndReplaces) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, "first"));
  EXPECT_EQ(test::bytes_of(path), "first");
  ASSERT_TRUE(write_file(path, std::string(100000, 'x')));
  EXPECT_EQ(test::bytes_of(path), std::string(100000, 'x'));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteFile, EndIsWrittenOverInItsPlace) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, "takes 1 s"));
  ASSERT_TRUE(write_over_end(path, "2 s"));
  EXPECT_EQ(test::bytes_of(path), "takes 2 s");
  EXPECT_FALSE(write_over_end(path, "longer than the file"));
  EXPECT_EQ(test::bytes_of(path), "takes 2 s");
  EXPECT_FALSE(write_over_end(folder.file("none.txt"), "x"));
}

TEST(WriteFile, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  const std::string path = folder.put("real.txt", "old");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  std::filesystem::create_symlink("real.txt", folder.file("link.txt"));
  ASSERT_TRUE(write_file(folder.file("link.txt"), "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.txt")));
  EXPECT_EQ(test::bytes_of(path), "new");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

// A process that ends where it stands, in any thread, leaves no file in the making. Finished ones and others' stay.
TEST(WriteFile, EndOfTheProcessLeavesNoUnfinishedFile) {
  const TemporaryFolder folder;
  folder.put("others.part", "another's");
  const auto ends_while_it_writes = [&] {
    const auto file = NewFile::make(*Folder::at(folder.file("")), "picture.png", NewFile::Name::temporary);
    if (!file || !write_file(folder.file("done.txt"), "whole") || folder.file_count() != 3) _exit(1);
    remove_unfinished_files();
    _exit(7);
  };
  EXPECT_EXIT(ends_while_it_writes(), testing::ExitedWithCode(7), "");
  EXPECT_EQ(test::bytes_of(folder.file("done.txt")), "whole");
  EXPECT_EQ(folder.file_count(), 2u);
}

/// The names that this process's next temporary files of `path` would have.
std::vector<std::string> plant_temporary_names(const std::string& path, const std::string& target) {
  std::vector<std::string> planted;
  for (int count = 0; count < 40; ++count) {
    planted.push_back(path + "." + std::to_string(::getpid()) + "-" + std::to_string(count) + ".part");
    std::filesystem::create_symlink(target, planted.back());
  }
  return planted;
}

// Names that can be guessed are no way to another file: links are not followed, and who planted them keeps them.
TEST(WriteFile, ATemporaryNameThatIsTakenIsLeftAndAnotherUsed) {
  const TemporaryFolder folder;
  const std::string outside = folder.put("outside", "mine");
  const auto planted = plant_temporary_names(folder.file("a.txt"), "outside");
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(write_file(folder.file("a.txt"), "new"));
  EXPECT_EQ(test::bytes_of(folder.file("a.txt")), "new");
  auto file = PartFile::create(folder.file("a.txt"));
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append("newer"));
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(test::bytes_of(folder.file("a.txt")), "newer");
  EXPECT_EQ(test::bytes_of(outside), "mine");
  for (const std::string& name : planted) EXPECT_TRUE(std::filesystem::is_symlink(name)) << name;
}

TEST(WriteFile, InAFolderNoLinkIsFollowed) {
  const TemporaryFolder folder;
  folder.put("outside/1", "mine");
  folder.put("out/a", "older");
  std::filesystem::create_symlink("../outside/1", folder.file("out/b"));
  std::filesystem::create_directory_symlink("../outside", folder.file("out/cells"));
  ASSERT_TRUE(write_file_in(folder.file("out"), "b", "new"));
  EXPECT_EQ(test::bytes_of(folder.file("out/b")), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(folder.file("out/b")));
  const auto written = write_file_in(folder.file("out"), "cells/1", "new");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::cannot_write);
  EXPECT_FALSE(make_output_subfolder(folder.file("out"), "cells"));
  EXPECT_EQ(test::bytes_of(folder.file("outside/1")), "mine");
  ASSERT_TRUE(make_output_subfolder(folder.file("out"), "thumbnails"));
  ASSERT_TRUE(write_file_in(folder.file("out"), "thumbnails/1", "new"));
  EXPECT_EQ(test::bytes_of(folder.file("out/thumbnails/1")), "new");
}

/// Restores the umask.
struct Umask {
  explicit Umask(mode_t mask) : before(::umask(mask)) {}
  ~Umask() { ::umask(before); }
  mode_t before;
};

TEST(WriteFile, AUmaskThatTakesAllAwayIsSaidAndNothingStays) {
  for (const mode_t mask : {0777u, 0377u, 0277u, 0600u, 0700u}) {
    const TemporaryFolder folder;
    const Umask taken(mask);
    const auto made = make_output_folder(folder.file("a/b"));
    ASSERT_FALSE(made) << mask;
    EXPECT_EQ(made.error().kind, ErrorKind::cannot_write);
    EXPECT_NE(made.error().message().find("umask"), std::string::npos) << made.error().message();
    EXPECT_EQ(folder.file_count(), 0u) << mask;
  }
}

TEST(PartFile, AppearsWholeWithTheOldPermissions) {
  const TemporaryFolder folder;
  const std::string path = folder.put("real.exr", "old");
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  auto file = PartFile::create(path);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append("to come, new"));
  ASSERT_TRUE(file->write_over_begin("is here"));
  ASSERT_TRUE(file->append("est"));
  EXPECT_EQ(test::bytes_of(path), "old");
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(test::bytes_of(path), "is here, newest");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(WriteFile, FullDeviceIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto written = write_file("/dev/full", "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(written.error().message(), "/dev/full: cannot write: No space left on device");
}

TEST(WriteFile, DevicesAreWrittenToDirectly) {
  EXPECT_TRUE(write_file("/dev/null", "x"));
}

TEST(WriteFile, FoldersAreErrors) {
  const TemporaryFolder folder;
  EXPECT_EQ(write_file(folder.path(), "x").error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(write_file(folder.file("missing/a.txt"), "x").error().kind, ErrorKind::cannot_write);
  const std::string file = folder.put("plain", "");
  EXPECT_EQ(write_file(file + "/a.txt", "x").error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(make_output_folder(file + "/sub").error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(make_output_folder(file).error().kind, ErrorKind::cannot_write);
}

TEST(WriteFile, UnwritableFolderIsFoundBeforehand) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const TemporaryFolder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0555), 0);
  EXPECT_EQ(make_output_folder(folder.path()).error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(write_file(folder.file("a"), "x").error().kind, ErrorKind::cannot_write);
  ::chmod(folder.path().c_str(), 0755);
}

TEST(WriteFile, OutputFolderIsMadeAndLeftEmpty) {
  const TemporaryFolder folder;
  ASSERT_TRUE(make_output_folder(folder.file("a/b/c")));
  EXPECT_TRUE(std::filesystem::is_empty(folder.file("a/b/c")));
  EXPECT_TRUE(make_output_folder(folder.file("a/b/c")));
}

// In a child process, with the signal's deadly default in force: 0 when all is as it should be.
int write_past_limit(const std::string& path) {
  ::signal(SIGXFSZ, SIG_DFL);
  const rlimit limit{4096, 4096};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
  const auto written = write_file(path, std::string(100000, 'x'));
  if (written) return 3;
  return written.error().kind == ErrorKind::cannot_write ? 0 : 4;
}

TEST(WriteFile, FileSizeLimitLeavesTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.put("a.txt", "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(write_past_limit(path));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(test::bytes_of(path), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace
}  // namespace gnomon
