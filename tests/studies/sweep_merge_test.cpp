// Shards put together: all of what they hold arrives, or an error says what could not be read, and the older result stays.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "studies/sweep/cell_files.h"
#include "studies/sweep/journal.h"
#include "studies/sweep/page.h"
#include "tests/support/scene_files_support.h"

namespace gnomon::studies {
namespace {

namespace fs = std::filesystem;

std::string merge_line(int cell) {
  std::string text =
      R"({"schema":"gnomon/result/1","scene":{"name":"s"},"command":"gnomon compare s","gl":{"backend":"osmesa","renderer":"llvmpipe"},"lights":[{
      "light":{"name":"sun","type":"directional"},"map":{"technique":"hard","size":64},"pixels":{"compared":9,
      "uncertain":0,"uncertain_by_samples":0},"classes":{},"edges":{"count":0,"rms_texels":null},"error":{"wrong":N,
      "ties":0,"false_shadow":0,"missed_shadow":0,"wrong_fraction":0.1,"mean_absolute":0.1,"rms":0.1,"flip":null,
      "ssim":null},"budget":[],"ladder":[]}],"size":{"width":2,"height":1},"costs":{"map_texels":1,"map_bytes":4},
      "axes":{"bias":N}})";
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n')) text.erase(at, 7);
  for (std::size_t at = text.find(":N"); at != std::string::npos; at = text.find(":N"))
    text.replace(at + 1, 1, std::to_string(cell));
  return sealed(text + "\n");
}

std::string merge_times(std::size_t cell) {
  std::string times = "\"lights\":[{";
  for (const char* pass : {"exact_shadows", "shadow_lookups", "map_pass", "shade_pass", "unshadowed_pass"})
    times += std::string("\"") + pass + R"(":{"median":1,"runs":[1]},)";
  times.back() = '}';
  return sealed("{\"cell\":" + std::to_string(cell) + R"(,"derived":false,"primary_rays":{"median":1},)" +
                times + "]}\n");
}

nlohmann::ordered_json unsealed(const std::string& line) {
  auto json = nlohmann::ordered_json::parse(line);
  json.erase("checksum");
  return json;
}

/// Two shards of a sweep of four cells.
class MergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int part = 1; part <= 2; ++part) {
      const std::size_t first = part - 1;
      auto journal =
          Journal::open(shard(part), make_header(R"({"scene":{"name":"s"},"options":{}})", 4, {part, 2}),
                        {axes(first), axes(first + 2)}, {first, first + 2});
      ASSERT_TRUE(journal) << journal.error().message();
      for (const std::size_t cell : {first, first + 2}) {
        ASSERT_TRUE(
            journal->append(unsealed(merge_line(static_cast<int>(cell))), unsealed(merge_times(cell))));
        const std::string folder = "shard" + std::to_string(part);
        files.put(folder + "/thumbnails/" + cell_name(cell) + ".png", "thumbnail of " + cell_name(cell));
        files.put(folder + "/cells/" + cell_name(cell) + ".js",
                  cell_data_file(cell, Image<std::uint8_t>(ImageSize{2, 1}), "truth-0123456789ab"));
        files.put(folder + "/cells/" + cell_name(cell) + ".png", "drawing of " + cell_name(cell));
      }
    }
    files.put("shard1/cells/truth-0123456789ab.png", "one truth");
    files.put("shard2/cells/truth-ba9876543210.png", "another truth");
  }
  static std::string axes(std::size_t cell) { return "{\"bias\":" + std::to_string(cell) + "}"; }
  std::string shard(int part) const { return files.file("shard" + std::to_string(part)); }
  Expected<MergedSweep> merge() const { return merge_sweeps({shard(1), shard(2)}, files.file("out")); }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> found;
    if (!fs::exists(files.file("out"))) return found;
    for (const auto& entry : fs::recursive_directory_iterator(files.file("out")))
      if (entry.is_regular_file()) found[entry.path().string()] = test::bytes_of(entry.path().string());
    return found;
  }
  TemporaryFolder files;
};

TEST_F(MergeTest, TakesAllThatTheShardsHold) {
  files.put("out/movie.mp4.part", "mine");
  files.put("out/cells/cell-7.png", "mine");
  for (int run = 0; run < 2; ++run) {
    const auto merged = merge();
    ASSERT_TRUE(merged) << merged.error().message();
    EXPECT_EQ(merged->cells, 4u);
    EXPECT_EQ(test::bytes_of(files.file("out/sweep.jsonl")),
              merge_line(0) + merge_line(1) + merge_line(2) + merge_line(3));
    EXPECT_EQ(test::bytes_of(files.file("out/thumbnails/cell-000003.png")), "thumbnail of cell-000003");
    EXPECT_EQ(test::bytes_of(files.file("out/cells/truth-ba9876543210.png")), "another truth");
    EXPECT_EQ(test::bytes_of(files.file("out/movie.mp4.part")), "mine");
    EXPECT_EQ(test::bytes_of(files.file("out/cells/cell-7.png")), "mine");
    EXPECT_TRUE(fs::exists(files.file("out/report.html")));
    EXPECT_EQ(contents().size(), 2u + 5u + 12u + 2u);
  }
  // A process that goes on there finds a finished sweep.
  const auto journal =
      Journal::open(files.file("out"), make_header(R"({"scene":{"name":"s"},"options":{}})", 4, {}),
                    {axes(0), axes(1), axes(2), axes(3)}, {0, 1, 2, 3});
  ASSERT_TRUE(journal) << journal.error().message();
  EXPECT_EQ(journal->size(), 4u);
}

TEST_F(MergeTest, RoundsOfTimesComeInTheOrderOfTheCells) {
  const auto add_rounds = [&](int part, std::size_t rounds) {
    const std::size_t first = part - 1;
    std::ofstream file(shard(part) + "/sweep_times.jsonl", std::ios::binary | std::ios::app);
    for (std::size_t round = 0; round < rounds; ++round)
      for (const std::size_t cell : {first, first + 2})
        file << sealed(
            "{\"cell\":" + std::to_string(cell) +
            R"(,"load":null,"lights":[{"map_pass":[3],"shade_pass":[4],"unshadowed_pass":[1],"shading_strips":[]}]})" +
            "\n");
  };
  add_rounds(1, 2);
  const auto unfinished = merge();
  ASSERT_FALSE(unfinished);
  EXPECT_NE(unfinished.error().message().find("a shard is not finished"), std::string::npos)
      << unfinished.error().message();
  add_rounds(2, 2);
  const auto merged = merge();
  ASSERT_TRUE(merged) << merged.error().message();
  const auto sweep = read_sweep(files.file("out"));
  ASSERT_TRUE(sweep) << sweep.error().message();
  ASSERT_EQ(sweep->rounds.size(), 12u);
  for (std::size_t i = 0; i < sweep->rounds.size(); ++i)
    EXPECT_EQ(nlohmann::json::parse(sweep->rounds[i])["cell"], i % 4) << i;
  EXPECT_EQ(nlohmann::json::parse(sweep->times[3])["lights"][0]["map_pass"]["runs"],
            (std::vector<double>{1.0, 3.0, 3.0}));
}

/// Puts what nobody can look at, a link to itself, in the place of something.
void make_unreadable(const std::string& path) {
  fs::remove_all(path);
  fs::create_symlink(fs::path(path).filename(), path);
}

TEST_F(MergeTest, WhatCannotBeReadIsNamedAndTheOlderResultStays) {
  for (const bool older : {false, true}) {
    if (older) {
      ASSERT_TRUE(merge());
      files.put("out/report.html", "older");
    }
    const auto before = contents();
    for (const char* name : {"thumbnails", "cells", "thumbnails/cell-000002.png", "cells/cell-000000.js",
                             "cells/truth-0123456789ab.png", "ray_tracer.json", "sweep_times.jsonl"}) {
      fs::rename(shard(1), files.file("kept"));
      fs::copy(files.file("kept"), shard(1), fs::copy_options::recursive);
      make_unreadable(shard(1) + "/" + name);
      const auto merged = merge();
      ASSERT_FALSE(merged) << name;
      EXPECT_EQ(merged.error().kind, ErrorKind::bad_input) << name;
      EXPECT_NE(merged.error().message().find(fs::path(name).begin()->string()), std::string::npos)
          << merged.error().message();
      EXPECT_EQ(contents(), before) << name;
      fs::remove_all(shard(1));
      fs::rename(files.file("kept"), shard(1));
    }
  }
}

TEST_F(MergeTest, AFolderOfAnotherSweepOrOneAtWorkIsRefused) {
  {
    const auto other = Journal::open(files.file("out"),
                                     make_header(R"({"scene":{"name":"t"},"options":{}})", 4, {}), {}, {});
    ASSERT_TRUE(other);
    const auto merged = merge();
    ASSERT_FALSE(merged);
    EXPECT_NE(merged.error().message().find("another process is at work"), std::string::npos);
  }
  const auto merged = merge();
  ASSERT_FALSE(merged);
  EXPECT_NE(merged.error().message().find("holds another sweep"), std::string::npos);
}

TEST_F(MergeTest, AnEditedLineInTheFolderIsNotReplaced) {
  ASSERT_TRUE(merge());
  std::string edited = merge_line(0);
  edited[edited.find("wrong\":0") + 7] = '5';
  files.put("out/sweep.jsonl", edited + merge_line(1));
  const auto merged = merge();
  ASSERT_FALSE(merged);
  EXPECT_EQ(test::bytes_of(files.file("out/sweep.jsonl")), edited + merge_line(1));
}

}  // namespace
}  // namespace gnomon::studies
