// Where outputs go something may lie that somebody else has put there, and the user's own umask may forbid what is made.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

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

// In a folder like /tmp, where the names of others lie beside the user's: a link to what is the user's, and a pipe.
TEST(HostileFolders, WhatOthersPlantInASharedFolderIsNotWrittenThrough) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to become another user";
  constexpr uid_t other = 65534;
  const auto shared = [](const TemporaryFolder& folder) {
    fs::create_directories(folder / "mine");
    write_text(folder / "mine/picture.png", "precious");
    fs::create_directories(folder / "out");
    EXPECT_EQ(::chmod((folder / "out").c_str(), 01777), 0);
  };
  const auto give_away = [](const std::string& path) { EXPECT_EQ(::lchown(path.c_str(), other, other), 0); };
  const Words raster{"raster", "thin-wall", "--size", "24x14", "--map-size", "64", "-o"};
  {
    const TemporaryFolder folder;
    shared(folder);
    fs::create_symlink("../mine/picture.png", folder / "out/picture.png");
    EXPECT_EQ(run_in(folder, raster + Words{"out/picture.png"}).exit_code, 0)
        << "a link of one's own is followed";
    EXPECT_NE(read_file(folder / "mine/picture.png"), "precious");
  }
  for (const bool pipe : {false, true}) {
    const TemporaryFolder folder;
    shared(folder);
    const std::string planted = folder / "out/picture.png";
    int reader = -1;  // who would write into the pipe does not wait for one
    if (pipe) {
      EXPECT_EQ(::mkfifo(planted.c_str(), 0666), 0);
      reader = ::open(planted.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    } else {
      fs::create_symlink("../mine/picture.png", planted);
    }
    give_away(planted);
    const ProcessResult done = run_in(folder, raster + Words{"out/picture.png"});
    if (reader >= 0) ::close(reader);
    EXPECT_EQ(done.exit_code, 4) << done.err;
    EXPECT_NE(done.err.find("belongs to another user"), std::string::npos) << done.err;
    EXPECT_EQ(read_file(folder / "mine/picture.png"), "precious");
  }
  const TemporaryFolder folder;
  shared(folder);
  fs::create_directory_symlink("../mine", folder / "out/report");
  give_away(folder / "out/report");
  EXPECT_EQ(run_in(folder, {"shaders", "-o", "out/report"}).exit_code, 4);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "mine"), {}), 1);
}

TEST(HostileFolders, ResultsGoWhereALinkOfOnesOwnLeads) {
  const TemporaryFolder folder;
  write_text(folder / "kept.json", "{}");
  fs::create_symlink("kept.json", folder / "result.json");
  const Words compare{"compare", "thin-wall", "--size", "24x14",      "--map-size",
                      "64",      "--runs",    "1",      "--no-report"};
  const ProcessResult done = run_in(folder, compare + Words{"--json", "result.json", "-o", "out"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(fs::is_symlink(folder / "result.json"));
  EXPECT_EQ(read_file(folder / "kept.json"), read_file(folder / "out/result.json"));
}

// A shard comes from somebody else: what it links to is not copied, and its data is not run by the page.
TEST(HostileFolders, AShardIsReadThroughNoLinkAndItsDataIsData) {
  const Words sweep{"sweep", "thin-wall", "--size", "24x14", "--map-size", "32,64", "--runs", "1", "-o"};
  const std::string cell = "shard/cells/cell-000000.js";
  {
    const TemporaryFolder folder;
    ASSERT_EQ(run_in(folder, sweep + Words{"shard"}).exit_code, 0);
    ASSERT_EQ(run_in(folder, {"merge", "shard", "-o", "whole"}).exit_code, 0);
    std::string data = read_file(folder / cell);
    data.replace(data.find("24"), 2, "(globalThis.run=1,24)");
    write_text(folder / cell, data);
    const ProcessResult merged = run_in(folder, {"merge", "shard", "-o", "whole2"});
    EXPECT_EQ(merged.exit_code, 3) << merged.err;
    EXPECT_NE(merged.err.find(cell + ": is no data of that cell"), std::string::npos) << merged.err;
    EXPECT_FALSE(fs::exists(folder / "whole2"));
    EXPECT_NE(run_in(folder, sweep + Words{"shard"}).exit_code, 0) << "nor when it is resumed";
  }
  for (const char* name :
       {"cells/cell-000000.png", "cells/cell-000000.js", "thumbnails/cell-000000.png", "cells"}) {
    const TemporaryFolder folder;
    write_text(folder / "secret", "a key");
    ASSERT_EQ(run_in(folder, sweep + Words{"shard"}).exit_code, 0);
    const std::string planted = folder / ("shard/" + std::string(name));
    fs::rename(planted, folder / "away");
    fs::create_symlink(std::string(name) == "cells" ? "../away" : "../../secret", planted);
    const ProcessResult merged = run_in(folder, {"merge", "shard", "-o", "whole"});
    EXPECT_EQ(merged.exit_code, 3) << name << ": " << merged.err;
    EXPECT_FALSE(fs::exists(folder / "whole")) << name;
  }
}

// "cp -al": a sweep goes on in the copy, and the original keeps what it has.
TEST(HostileFolders, ASweepWritesNothingIntoAnotherNameOfItsFiles) {
  const TemporaryFolder folder;
  const Words sweep{"sweep", "thin-wall", "--size", "24x14", "--map-size", "32,64", "--runs", "1", "-o"};
  write_text(folder / "notes", "");
  fs::create_directories(folder / "out");
  fs::create_hard_link(folder / "notes", folder / "out/sweep.jsonl");
  const ProcessResult done = run_in(folder, sweep + Words{"out"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(read_file(folder / "notes"), "");
  EXPECT_NE(read_file(folder / "out/sweep.jsonl"), "");
}

const Words quick_compare{"compare", "thin-wall", "--size", "24x14", "--map-size", "64", "--runs", "1"};

// As a program that spares room makes them of files that are alike, and as somebody may plant them.
TEST(HostileFolders, LinksBetweenAFoldersFilesAreReplacedByFiles) {
  for (const bool hard : {false, true}) {
    const TemporaryFolder folder;
    write_text(folder / "mine", "precious");
    fs::create_directories(folder / "out");
    for (const char* name : {"out/report.html", "out/result.json", "out/result.csv"})
      if (hard)
        fs::create_hard_link(folder / "mine", folder / name);
      else
        fs::create_symlink("../mine", folder / name);
    const ProcessResult done = run_in(folder, quick_compare + Words{"-o", "out"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(read_file(folder / "mine"), "precious");
    EXPECT_TRUE(read_file(folder / "out/result.json").starts_with("{"));
    EXPECT_TRUE(read_file(folder / "out/report.html").starts_with("<!"));
  }
}

TEST(HostileFolders, OutputsThatALinkMakesOneAreSaidToBe) {
  const TemporaryFolder folder;
  write_text(folder / "mine", "precious");
  fs::create_symlink("mine", folder / "a.json");
  const ProcessResult done = run_in(folder, {"raster", "thin-wall", "--size", "24x14", "-o", "x.png",
                                             "--json", "a.json", "--trace", "mine"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_NE(done.err.find("two outputs that a link makes one file (got a.json and mine)"), std::string::npos)
      << done.err;
  EXPECT_EQ(read_file(folder / "mine"), "precious");
}

// A folder of a group's, where each may replace what the others made.
TEST(HostileFolders, FilesOfAnotherUserAreReplacedWhereThatIsAllowed) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to become another user";
  const TemporaryFolder folder;
  const Words compare = quick_compare + Words{"-o", "out"};
  ASSERT_EQ(run_in(folder, compare).exit_code, 0);
  const auto names = folder.entries();
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_EQ(::lchown(entry.path().c_str(), 65534, 65534), 0);
  const ProcessResult done = run_in(folder, compare);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  EXPECT_EQ(folder.entries(), names);
}

TEST(HostileFolders, NoAddressIsNotAllOfThem) {
  const TemporaryFolder folder;
  const ProcessResult done =
      run_in(folder, {"serve", "thin-wall", "--listen", ""}, {.interrupt_after_ms = 200});
  EXPECT_EQ(done.exit_code, 2) << done.err;
}

}  // namespace
}  // namespace gnomon::app_test
