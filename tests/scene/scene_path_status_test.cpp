// Questions about paths: "nothing is there" is never said where nobody could look.
#include <sys/stat.h>

#include <algorithm>

#include "scene/files/path_status.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

/// Names that cannot be looked at, whoever asks: a link to itself, one that is too long, and what would lie below them.
std::vector<std::string> unreadable_paths(const TemporaryFolder& folder) {
  fs::create_symlink("circle", folder.file("circle"));
  return {folder.file("circle"), folder.file("circle/below"), folder.file(std::string(300, 'n')),
          folder.path() + "/" + std::string(5000, 'p')};
}

TEST(PathStatus, WhatCannotBeLookedAtIsNotCalledAbsent) {
  const TemporaryFolder folder;
  for (const std::string& path : unreadable_paths(folder)) {
    EXPECT_FALSE(file_kind(path)) << path;
    EXPECT_FALSE(is_there(path)) << path;
    EXPECT_FALSE(is_folder(path)) << path;
    EXPECT_FALSE(is_plain_file(path)) << path;
    EXPECT_FALSE(names_in(path)) << path;
    EXPECT_FALSE(names_if_there(path)) << path;
    EXPECT_FALSE(files_below(path)) << path;
    EXPECT_FALSE(size_of_file(path)) << path;
    EXPECT_FALSE(are_one_path(path, folder.path())) << path;
    const auto asked = is_there(path, ErrorKind::cannot_write);
    ASSERT_FALSE(asked);
    EXPECT_EQ(asked.error().kind, ErrorKind::cannot_write);
    EXPECT_NE(asked.error().message().find("cannot be looked at: "), std::string::npos);
    EXPECT_EQ(file_kind_or_none(path), FileKind::none);
  }
}

TEST(PathStatus, AnswersOfWhatIsThere) {
  const TemporaryFolder folder;
  const std::string file = folder.put("deep/er/file", "12345");
  fs::create_symlink(file, folder.file("link"));
  fs::create_symlink("nowhere", folder.file("dangling"));
  EXPECT_EQ(file_kind(file), FileKind::file);
  EXPECT_EQ(file_kind(folder.file("link")), FileKind::file);
  EXPECT_EQ(file_kind(folder.file("deep")), FileKind::folder);
  EXPECT_EQ(file_kind("/dev/null"), FileKind::other);
  for (const char* absent : {"absent", "dangling", "link/below", "absent/below"})
    EXPECT_EQ(file_kind(folder.file(absent)), FileKind::none) << absent;
  EXPECT_EQ(size_of_file(file), 5u);
  EXPECT_FALSE(size_of_file(folder.file("deep")));
  EXPECT_EQ(are_one_path(file, folder.file("link")), true);
  EXPECT_EQ(are_one_path(file, folder.file("absent")), false);
}

TEST(PathStatus, WhatIsNoPlainFileIsCalledWhatItIs) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  fs::create_directory(folder.file("deep"));
  for (const auto& [path, words] : {std::pair(folder.file("absent"), "no such file"),
                                    std::pair(folder.file("deep"), "is a folder, not a file"),
                                    std::pair(folder.file("pipe"), "is a pipe, not a file"),
                                    std::pair(std::string("/dev/null"), "is a device, not a file")}) {
    const auto size = size_of_file(path);
    ASSERT_FALSE(size) << path;
    EXPECT_EQ(size.error().reason, words) << path;
  }
}

TEST(PathStatus, ListsAreWholeAndSorted) {
  const TemporaryFolder folder;
  for (const char* name : {"b", "a", "sub/c"}) folder.put(name, "x");
  fs::create_symlink("..", folder.file("sub/up"));
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"a", "b", "sub"}));
  EXPECT_EQ(files_below(folder.path()), (std::vector<std::string>{"a", "b", "sub/c", "sub/up"}));
  EXPECT_FALSE(names_in(folder.file("absent")));
  EXPECT_EQ(names_if_there(folder.file("absent")), std::vector<std::string>{});
  EXPECT_FALSE(names_in(folder.file("a")));
  EXPECT_FALSE(names_if_there(folder.file("a"))) << "a file in a folder's place";
}

TEST(PathStatus, RemovingSaysWhatItCouldNot) {
  const TemporaryFolder folder;
  folder.put("full/file", "x");
  EXPECT_TRUE(remove_path(folder.file("absent")));
  const auto full = remove_path(folder.file("full"));
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().kind, ErrorKind::cannot_write);
  EXPECT_TRUE(remove_all_of(folder.file("full")));
  EXPECT_FALSE(fs::exists(folder.file("full")));
}

}  // namespace
}  // namespace gnomon
