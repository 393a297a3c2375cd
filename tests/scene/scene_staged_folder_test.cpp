// Folders of outputs that several processes make at the same time.
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

/// How many of so many processes, which begin together, say that all went well.
int processes_that_succeed(int count, const std::function<bool()>& work) {
  int gate[2];
  if (pipe(gate) != 0) return 0;
  std::vector<pid_t> children;
  for (int i = 0; i < count; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      close(gate[1]);
      char byte = 0;
      if (read(gate[0], &byte, 1) != 0) _exit(2);  // the end of file is the sign to begin
      _exit(work() ? 0 : 1);
    }
    children.push_back(child);
  }
  close(gate[0]), close(gate[1]);
  int succeeded = 0;
  for (const pid_t child : children) {
    int status = 1;
    waitpid(child, &status, 0);
    succeeded += status == 0 ? 1 : 0;
  }
  return succeeded;
}

// Each looks for what killed processes left, and must not take for that what another has just begun.
TEST(StagedFolder, ThatHasJustBegunIsNotAbandoned) {
  const TemporaryFolder folder;
  const std::string target = folder.file("out");
  EXPECT_EQ(processes_that_succeed(4,
                                   [&] {
                                     for (int i = 0; i < 500; ++i) {
                                       const auto staged = StagedFolder::open(target);
                                       if (!staged || !write_file(staged->path() + "/a.txt", "a"))
                                         return false;
                                     }
                                     return true;
                                   }),
            4);
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(StagedFolder, OfSeveralProcessesAreNeverMixed) {
  const TemporaryFolder folder;
  const std::string target = folder.file("out");
  EXPECT_EQ(processes_that_succeed(3,
                                   [&] {
                                     const std::string own = std::to_string(::getpid());
                                     for (int i = 0; i < 60; ++i) {
                                       auto staged = StagedFolder::open(target);
                                       if (!staged) return false;
                                       for (const char* name : {"/a", "/b", "/c", "/d"})
                                         if (!write_file(staged->path() + name, own)) return false;
                                       if (!staged->seal({}) || !staged->publish("d")) return false;
                                     }
                                     return true;
                                   }),
            3);
  const std::string last = test::bytes_of(target + "/d");
  EXPECT_FALSE(last.empty());
  for (const char* name : {"/a", "/b", "/c"}) EXPECT_EQ(test::bytes_of(target + name), last);
}

}  // namespace
}  // namespace gnomon
