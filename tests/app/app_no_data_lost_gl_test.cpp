// No output takes the place of an input or of another output, folders appear whole, and long names work.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

const std::string scene_text =
    R"({"schema": "gnomon/scene/1",
        "materials": [{"name": "m", "texture": {"file": "tex.png"}}],
        "shapes": [{"name": "s", "sphere": {"center": [0, 1, 0], "radius": 1}, "material": "m"}]})";

/// A folder with scene.json, whose texture is tex.png, and names that lead to them.
struct World {
  TemporaryFolder folder;
  World() {
    write_text(folder / "scene.json", scene_text);
    EXPECT_EQ(run({"raytrace", "sphere-plane", "--size", "8x8", "-o", "tex.png"}).exit_code, 0);
    fs::create_symlink("scene.json", folder / "link.json");
    fs::create_hard_link(folder / "tex.png", folder / "hard.png");
    before = {read_file(folder / "scene.json"), read_file(folder / "tex.png")};
  }
  ProcessResult run(const Words& words) const { return run_gnomon(words, {.folder = folder.path()}); }
  bool untouched() const {
    return before == Words{read_file(folder / "scene.json"), read_file(folder / "tex.png")};
  }
  Words before;
};

TEST(NoDataLost, AnOutputThatIsAnInputIsRefused) {
  const World world;
  const std::vector<Words> calls = {
      {"raytrace", "scene.json", "--json", "scene.json", "-o", "o.png"},
      {"raytrace", "scene.json", "--json", "link.json", "-o", "o.png"},
      {"raytrace", "scene.json", "--json", "./sub/../scene.json", "-o", "o.png"},
      {"raytrace", "link.json", "--json", "scene.json", "-o", "o.png"},
      {"raytrace", "scene.json", "-o", "tex.png"},
      {"raytrace", "scene.json", "-o", "hard.png"},
      {"raytrace", "scene.json", "-o", "o.png", "--json", "tex.png"},
      {"raster", "scene.json", "--json", "scene.json", "-o", "o.png"},
      {"compare", "scene.json", "--json", "scene.json"},
      {"compare", "scene.json", "--trace", "scene.json"},
      {"raytrace", "scene.json", "-o", "o.png", "--trace", "tex.png"},
      {"raster", "scene.json", "-o", "o.png", "--trace", "scene.json"},
      {"sweep", "scene.json", "--map-size", "32,64", "--trace", "scene.json"},
      {"sweep", "scene.json", "--map-size", "32,64", "--slurm", "2", "--trace", "scene.json"},
      {"shimmer", "scene.json", "--trace", "scene.json"},
      {"tune", "scene.json", "--max-error", "1%", "--trace", "scene.json"},
      {"plan", "scene.json", "--json", "scene.json"},
      {"tune", "scene.json", "--max-error", "1%", "--json", "tex.png"},
      {"bench", "scene.json", "--json", "scene.json"}};
  fs::create_directory(world.folder / "sub");
  for (const Words& call : calls) {
    expect_one_line(world.run(call), 2, "this file is also an input, which would be lost (got ");
    EXPECT_TRUE(world.untouched()) << call[0] << " " << call.back();
  }
  EXPECT_FALSE(fs::exists(world.folder / "o.png"));
}

TEST(NoDataLost, TwoOutputsOfOneNameAreRefused) {
  const World world;
  expect_one_line(world.run({"raytrace", "scene.json", "--json", "x.exr", "-o", "x.exr"}), 2,
                  "-o and --json: two outputs of one name (got x.exr)");
  expect_one_line(world.run({"compare", "fence", "--json", "x.exr", "--aov", "./x.exr"}), 2, "two outputs");
  expect_one_line(world.run({"compare", "fence", "-o", "d", "--json", "d/report.html"}), 2, "two outputs");
  expect_one_line(world.run({"compare", "fence", "-o", "d", "--trace", "d/result.json"}), 2, "two outputs");
  expect_one_line(world.run({"raytrace", "fence", "-o", "x.exr", "--trace", "x.exr"}), 2, "two outputs");
  EXPECT_FALSE(fs::exists(world.folder / "x.exr"));
  // A device is nobody's file.
  EXPECT_EQ(world.run({"plan", "scene.json", "--json", "/dev/null", "-q"}).exit_code, 0);
}

TEST(NoDataLost, AnEditedShaderStays) {
  const World world;
  ASSERT_EQ(world.run({"shaders", "-o", "mine"}).exit_code, 0);
  const std::string shader = "mine/technique/hard.glsl", before = read_file(world.folder / shader);
  for (const char* command : {"compare", "raster", "shimmer"})
    expect_one_line(world.run({command, "fence", "--shader-dir", "mine", "--json", shader}), 2,
                    "this file is also an input, which would be lost (got ");
  expect_one_line(
      world.run({"sweep", "fence", "--map-size", "32,64", "--shader-dir", "mine", "--trace", shader}), 2,
      "this file is also an input");
  EXPECT_EQ(read_file(world.folder / shader), before);
}

// The scene lies where the folder's files go, and so does its texture.
TEST(NoDataLost, AFolderOfOutputsKeepsItsInputs) {
  const World world;
  fs::create_directory(world.folder / "d");
  fs::rename(world.folder / "tex.png", world.folder / "d/raster.png");
  const std::string texture = read_file(world.folder / "d/raster.png");
  write_text(world.folder / "d/scene.json",
             std::string(scene_text).replace(scene_text.find("tex.png"), 7, "raster.png"));
  expect_one_line(world.run(Words{"compare", "d/scene.json", "-o", "d", "-q"} + small), 2, "d/raster.png");
  EXPECT_EQ(read_file(world.folder / "d/raster.png"), texture);
  fs::rename(world.folder / "d/scene.json", world.folder / "d/result.json");
  expect_one_line(world.run({"compare", "d/result.json", "-o", "d", "-q"}), 2, "d/result.json");
}

// Files of other names stay when a comparison is written into their folder again; nothing is left beside it.
TEST(NoDataLost, ForeignFilesStay) {
  const TemporaryFolder folder;
  const Words words = Words{"compare", "acne-floor", "-o", "out", "-q"} + small;
  fs::create_directories(folder / "out/notes");
  write_text(folder / "out/notes/mine.txt", "mine");
  for (int run = 0; run < 2; ++run) {
    ASSERT_EQ(run_gnomon(words, {.folder = folder.path()}).exit_code, 0);
    EXPECT_EQ(read_file(folder / "out/notes/mine.txt"), "mine");
    EXPECT_TRUE(fs::exists(folder / "out/report.html"));
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

// A file-size limit stands for a full disk: nothing of the folder is there, or all of what was.
TEST(NoDataLost, AFullDiskLeavesNoPartOfAFolder) {
  const TemporaryFolder folder, shader_cache;  // an empty cache, so that the driver meets the limit first
  const auto limited = [&](const std::string& out) {
    const Words words = Words{"compare", "acne-floor", "-o", out, "-q"} + small;
    return run_gnomon(words, {.folder = folder.path(),
                              .environment = {"MESA_SHADER_CACHE_DIR=" + shader_cache.path()},
                              .file_size_limit = 20000});
  };
  expect_one_line(limited("new"), 4, "");
  EXPECT_TRUE(folder.entries().empty());
  ASSERT_EQ(run_gnomon(Words{"compare", "acne-floor", "-o", "old", "-q"} + small, {.folder = folder.path()})
                .exit_code,
            0);
  const std::string page = read_file(folder / "old/report.html"),
                    json = read_file(folder / "old/result.json");
  expect_one_line(limited("old"), 4, "");
  EXPECT_EQ(read_file(folder / "old/report.html"), page);
  EXPECT_EQ(read_file(folder / "old/result.json"), json);
}

/// All that lies in a folder, by name.
std::map<std::string, std::string> all_files(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[entry.path().string()] = entry.is_regular_file() ? read_file(entry.path().string()) : "a folder";
  return files;
}

/// Two shards of a sweep, and two captures that are right.
struct InputsOfSets {
  TemporaryFolder folder;
  InputsOfSets() {
    for (const char* part : {"1", "2"})
      run(Words{"sweep", "acne-floor", "--bias", "0,0.1", "--shard", std::string(part) + "/2", "-o",
                std::string("shard") + part, "-q"} +
          small);
    run({"export", "--suite", "suite", "--size", "16x9", "-q"});
    for (const char* name : {"a", "b"}) {
      fs::create_directories(folder / (std::string("captures/") + name));
      for (const char* file : {"/cube-seams.glb", "/cube-seams.exr"})
        fs::copy_file(folder / "suite" + file, folder / (std::string("captures/") + name) + file);
      write_text(folder / (std::string("captures/") + name) + "/capture.json",
                 R"({"schema": "gnomon/capture/1", "renderer": {"name": "x"}, "size": [16, 9],
                     "scene": "cube-seams.glb", "visibility": "cube-seams.exr"})");
    }
  }
  void run(const Words& words) const {
    const ProcessResult result = run_gnomon(words, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
};

const std::vector<Words> sets = {{"shaders", "-q", "-o"},
                                 {"export", "-q", "--size", "16x9", "--suite"},
                                 {"merge", "-q", "shard1", "shard2", "-o"},
                                 {"judge", "-q", "--suite", "captures", "-o"}};

// The disk is full at some file of many: none of them is there, or all of the older ones.
TEST(NoDataLost, SetsOfFilesAreThereWholeOrNotAtAll) {
  const InputsOfSets inputs;
  const auto limited = [&](const Words& words) {
    return run_gnomon(words, {.folder = inputs.folder.path(), .file_size_limit = 3000});
  };
  for (const Words& words : sets) {
    const auto before = all_files(inputs.folder.path());
    expect_one_line(limited(words + Words{"new"}), 4, "");
    EXPECT_EQ(all_files(inputs.folder.path()), before) << words[0];
    inputs.run(words + Words{"old-" + words[0]});
    const auto older = all_files(inputs.folder.path());
    expect_one_line(limited(words + Words{"old-" + words[0]}), 4, "");
    EXPECT_EQ(all_files(inputs.folder.path()), older) << words[0];
  }
}

TEST(NoDataLost, FilesOfOthersStayInAFolderOfASet) {
  const InputsOfSets inputs;
  std::vector<Words> calls = sets;
  calls.push_back(Words{"sweep", "acne-floor", "-q"} + small + Words{"-o"});
  for (const Words& words : calls) {
    const std::string out = "out-" + words[0];
    for (const char* name :
         {"movie.mp4.part", "cells/cell-7.png", "cells/download.part", "thumbnails/x.part"}) {
      fs::create_directories(fs::path(inputs.folder / (out + "/" + name)).parent_path());
      write_text(inputs.folder / (out + "/" + name), "mine");
    }
    for (int run = 0; run < 2; ++run) inputs.run(words + Words{out});
    for (const char* name :
         {"movie.mp4.part", "cells/cell-7.png", "cells/download.part", "thumbnails/x.part"})
      EXPECT_EQ(read_file(inputs.folder / (out + "/" + name)), "mine") << words[0] << " " << name;
  }
}

// Said before a long run, and not after it.
TEST(NoDataLost, AFolderThatCannotBeMadeIsRefusedByEveryCommand) {
  const InputsOfSets inputs;
  write_text(inputs.folder / "file", "mine");
  fs::create_symlink("circle", inputs.folder / "circle");
  fs::create_symlink("nowhere", inputs.folder / "dangling");
  std::vector<Words> calls = sets;
  for (const Words& words :
       {Words{"compare", "acne-floor"}, Words{"sweep", "acne-floor"}, Words{"lessons"},
        Words{"shimmer", "acne-floor"}, Words{"tune", "acne-floor", "--max-error", "1%"}})
    calls.push_back(words + Words{"-q", "-o"});
  for (const Words& words : calls)
    for (const char* folder : {"file", "file/below", "circle", "circle/below", "dangling", "/proc/below"})
      expect_one_line(run_gnomon(words + Words{folder}, {.folder = inputs.folder.path()}), 4, "");
  EXPECT_EQ(read_file(inputs.folder / "file"), "mine");
  EXPECT_TRUE(fs::is_symlink(inputs.folder / "dangling"));
}

TEST(NoDataLost, NamesOfTheLongestLength) {
  const TemporaryFolder folder;
  const std::string image = std::string(251, 'a') + ".png", directory(255, 'd');
  EXPECT_EQ(
      run_gnomon({"raytrace", "acne-floor", "--size", "8x8", "-o", image, "-q"}, {.folder = folder.path()})
          .exit_code,
      0);
  EXPECT_EQ(
      run_gnomon(Words{"compare", "acne-floor", "-o", directory, "-q"} + small, {.folder = folder.path()})
          .exit_code,
      0);
  EXPECT_TRUE(fs::exists(folder / image) && fs::exists(folder / directory));
}

TEST(Outside, FilesOutsideTheScenesFolderNeedTheOption) {
  const World world;
  fs::create_directory(world.folder / "inner");
  write_text(world.folder / "inner/scene.json",
             std::string(scene_text).replace(scene_text.find("tex.png"), 7, "../tex.png"));
  const Words words = {"raytrace", "inner/scene.json", "--size", "8x8", "-o", "o.png", "-q"};
  expect_one_line(world.run(words), 3, "outside the scene's folder (got \"../tex.png\", allowed ");
  EXPECT_EQ(world.run(words + Words{"--allow-outside"}).exit_code, 0);
  // What an included file names is inside as long as it lies below the main file's folder.
  write_text(world.folder / "outer.json", R"({"schema": "gnomon/scene/1", "include": ["inner/scene.json"]})");
  EXPECT_EQ(world.run({"raytrace", "outer.json", "--size", "8x8", "-o", "o.png", "-q"}).exit_code, 0);
}

}  // namespace
}  // namespace gnomon::app_test
