// Where outputs go something may lie that somebody else has put there, and the user's own umask may forbid what is made.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

/// Commands of a tenth of a second, and what each writes in "out".
const std::vector<Words> commands = {
    {"shaders", "-o", "out"},
    {"grade", "--new", "out"},
    {"export", "--suite", "out", "--size", "24x14"},
    {"raster", "thin-wall", "--size", "24x14", "--map-size", "64", "-o", "out/picture.png", "--json",
     "out/picture.json"},
    {"raytrace", "thin-wall", "--size", "24x14", "-o", "out/picture.exr", "--json", "out/picture.json"},
    {"export", "thin-wall", "-o", "out/scene.glb"},
    {"plan", "thin-wall", "--json", "out/plan.json"}};
/// Those that write a whole folder.
constexpr std::size_t folders = 3;

std::map<std::string, std::string> contents(const TemporaryFolder& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    found[entry.path().lexically_relative(folder.path())] =
        entry.is_symlink()        ? "link to " + fs::read_symlink(entry.path()).string()
        : entry.is_regular_file() ? read_file(entry.path())
                                  : "";
  return found;
}

ProcessResult run_in(const TemporaryFolder& folder, const Words& words, ProcessOptions options = {}) {
  options.folder = folder.path();
  return run_gnomon(words + Words{"-q"}, options);
}

// As in a repository that somebody else made: a list of what to move, with a way out by its names and one by a link.
TEST(HostileFolders, AListInAFolderMovesNothing) {
  for (std::size_t i = 0; i < folders; ++i) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "hooks");
    fs::create_directories(folder / "out/.gnomon.1.part/.replaced/l");
    const std::string list =
        std::string("7 7 ../hooks/pre-commit\0", 24) + std::string("7 7 l/pre-commit\0", 17);
    write_text(folder / "out/.gnomon.1.part/.publishing", list);
    write_text(folder / "out/.gnomon.1.part/.replaced/l/pre-commit", "planted");
    fs::create_directories(folder / "out/.gnomon.1.part/.replaced/../hooks");
    write_text(folder / "out/.gnomon.1.part/hooks/pre-commit", "planted");
    fs::create_directory_symlink("../hooks", folder / "out/l");
    const ProcessResult done = run_in(folder, commands[i]);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(fs::is_empty(folder / "hooks")) << commands[i][0];
    EXPECT_FALSE(fs::exists(folder / "out/.gnomon.1.part"));
  }
}

TEST(HostileFolders, WhatIsNotTheUsersOwnIsLeftAndSaidOnce) {
  for (std::size_t i = 0; i < folders; ++i) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "outside");
    fs::create_directories(folder / "out");
    write_text(folder / "out/.gnomon.1.part", "a file");
    fs::create_directory_symlink("../outside", folder / "out/.gnomon.2.part");
    fs::create_symlink("nowhere", folder / "out.gnomon.3.part");
    const auto planted = contents(folder);
    const ProcessResult done = run_in(folder, commands[i]);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    for (const char* name :
         {"out/.gnomon.1.part (no folder)", "out/.gnomon.2.part (a link)", "out.gnomon.3.part (a link)"})
      EXPECT_NE(done.err.find(name), std::string::npos) << done.err;
    const auto after = contents(folder);
    for (const auto& [name, content] : planted) EXPECT_EQ(after.at(name), content) << name;
  }
}

// What another program would write through: the logs and folders of Slurm's tasks.
TEST(HostileFolders, LinksAreNotLeftForOtherProgramsToFollow) {
  for (const char* name : {"slurm-1.log", "shard-2"}) {
    const TemporaryFolder folder;
    write_text(folder / "outside", "mine");
    fs::create_directories(folder / "out");
    fs::create_symlink("../outside", folder / ("out/" + std::string(name)));
    const ProcessResult done =
        run_in(folder, {"sweep", "thin-wall", "--map-size", "32,64", "--slurm", "2", "-o", "out"});
    EXPECT_EQ(done.exit_code, 4) << done.err;
    EXPECT_NE(done.err.find(name + std::string(": is a link")), std::string::npos) << done.err;
    EXPECT_EQ(read_file(folder / "outside"), "mine");
  }
}

// Files of the user's own: nothing is made that its maker may neither read nor write.
TEST(HostileFolders, AUmaskThatTakesAllAwayIsSaidAndNothingStays) {
  for (const Words& command : commands)
    for (const bool there : {false, true})
      for (void (*const umask_of)() : {+[] { ::umask(0777); }, +[] { ::umask(0277); }}) {
        const TemporaryFolder folder;
        if (there) fs::create_directories(folder / "out");
        const auto before = contents(folder);
        const ProcessResult done = run_in(folder, command, {.prepare = umask_of});
        EXPECT_EQ(done.exit_code, 4) << command[0] << " " << command[1];
        EXPECT_NE(done.err.find("umask"), std::string::npos) << done.err;
        EXPECT_EQ(contents(folder), before) << command[0] << " " << command[1];
      }
}

// Of two outputs none is new while the other is older, whichever of the steps fails.
TEST(HostileFolders, OutputsOfOneRunAppearTogether) {
  const Words raster{"raster",          "thin-wall", "--map-size",         "64",    "-o",
                     "out/picture.png", "--json",    "other/picture.json", "--size"};
  for (int at = 1;; ++at) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_in(folder, raster + Words{"24x14"}).exit_code, 0);
    const auto older = contents(folder);
    const ProcessResult done = run_in(
        folder, raster + Words{"32x18"},
        {.environment = {"LD_PRELOAD=" + test::fault_injector(), "GNOMON_FAULT_CALL=rename",
                         "GNOMON_FAULT_FOLDERS=" + folder.path(), "GNOMON_FAULT_AT=" + std::to_string(at)}});
    if (done.exit_code == 0) {
      EXPECT_GT(at, 2);
      break;
    }
    EXPECT_EQ(done.exit_code, 4) << done.err;
    EXPECT_EQ(contents(folder), older) << at << ": " << done.err;
  }
}

}  // namespace
}  // namespace gnomon::app_test
