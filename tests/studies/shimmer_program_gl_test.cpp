// gnomon shimmer seen from outside: its files, its exit codes, and what it says of a wrong call.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/app_process.h"
#include "tests/support/gltf_support.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

const Words quick = {"shimmer", "thin-wall", "--size", "192x108", "--map-size", "64", "--frames", "3"};

TEST(ShimmerProgram, WritesItsFolderWhole) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(quick + Words{"--json", "-", "-o", folder / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json printed = json::parse(result.out);
  EXPECT_EQ(printed["schema"], "gnomon/shimmer/1");
  EXPECT_EQ(printed["frames"], 3);
  EXPECT_EQ(result.out, read_file(folder / "out/result.json"));
  for (const char* name : {"report.html", "film-0-drawn.png", "film-0-truth.png", "film-0-flips.png"})
    EXPECT_FALSE(read_file(folder / "out" + "/" + name).empty()) << name;
}

TEST(ShimmerProgram, ThresholdDecidesTheExitCode) {
  const Words json_only = {"--json", "-", "--path", "drift", "--drift", "0.5,0.5"};
  const ProcessResult moved = run_gnomon(quick + json_only);
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  ASSERT_GT(json::parse(moved.out)["lights"][0]["flips"], 0);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--fail-above", "0"}).exit_code, 1);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--fail-above", "1000"}).exit_code, 0);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--snap", "--fail-above", "0"}).exit_code, 0);
}

/// A box of half side 1 that drives 2 units a second along x from -2 on for two seconds, over a ground and under a sun.
/// `stored`: the x that it is stored at; `by_weights`: a morph target drives it, not its node.
std::string driving_box(double stored = -2.0, bool by_weights = false) {
  gltf_test::Builder b;
  const auto box = [&](float x, float y0, float y1, float z) {
    std::vector<float> corners;
    for (const float y : {y0, y1})
      for (const float s : {-1.0f, 1.0f})
        for (const float r : {-1.0f, 1.0f}) corners.insert(corners.end(), {r * x, y, s * z});
    return b.positions(corners);
  };
  const std::vector<std::uint16_t> sides{0, 1, 3, 0, 3, 2, 4, 7, 5, 4, 6, 7, 0, 5, 1, 0, 4, 5,
                                         2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  const auto mesh = [&](int positions) {
    return json{
        {"primitives",
         {{{"attributes", {{"POSITION", positions}}}, {"indices", b.accessor(sides, 5123, "SCALAR", 1)}}}}};
  };
  b.json["meshes"] = {mesh(box(12.0f, -1.0f, 0.0f, 12.0f)), mesh(box(1.0f, 0.0f, 1.5f, 1.0f))};
  b.json["cameras"] =
      json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}});
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] =
      json::array({{{"type", "directional"}, {"name", "sun"}}});
  const double half = std::sqrt(0.5), light = std::sin(pi / 6.0), lit = std::cos(pi / 6.0);
  b.json["nodes"] = {
      {{"name", "ground"}, {"mesh", 0}},
      {{"name", "box"}, {"mesh", 1}, {"translation", {stored, 0, 0}}},
      {{"name", "eye"}, {"camera", 0}, {"translation", {0, 14, 0}}, {"rotation", {-half, 0, 0, half}}},
      {{"name", "sun"},
       {"rotation", {-lit, 0, 0, light}},
       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  b.json["scenes"] = json::array({{{"nodes", {0, 1, 2, 3}}}});
  const int times = b.accessor(std::vector<float>{0, 2}, 5126, "SCALAR", 1);
  const int way = b.accessor(std::vector<float>{-2, 0, 0, 2, 0, 0}, 5126, "VEC3", 3);
  const int weights = b.accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 1);
  b.json["animations"] = json::array(
      {{{"name", "drive"},
        {"samplers", {{{"input", times}, {"output", by_weights ? weights : way}}}},
        {"channels",
         {{{"sampler", 0}, {"target", {{"node", 1}, {"path", by_weights ? "weights" : "translation"}}}}}}}});
  if (by_weights)
    b.json["meshes"][1]["primitives"][0]["targets"] =
        json::array({{{"POSITION", b.positions(std::vector<float>{4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0,
                                                                  4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0})}}});
  return b.text();
}

// Map and truth follow the box alike: exact shadows do not flip, coarse ones do. Receivers on the ground stay; those that
// the box stands on, or that it comes to hide, do not count then.
TEST(ShimmerProgram, PlaysObjects) {
  const TemporaryFolder folder;
  const std::string scene = folder / "driving.gltf";
  std::ofstream(scene) << driving_box();
  const Words film = {"shimmer",  scene, "--size", "96x64", "--map-size", "64",
                      "--frames", "5",   "--fps",  "4",     "--json",     "-"};
  const ProcessResult coarse = run_gnomon(film);
  ASSERT_EQ(coarse.exit_code, 0) << coarse.err;
  EXPECT_EQ(coarse.err.find("not played"), std::string::npos) << coarse.err;
  const json played = json::parse(coarse.out), light = played["lights"][0];
  EXPECT_EQ(played["path"]["name"], "drive");
  EXPECT_EQ(played["path"]["objects"], true);
  EXPECT_EQ(played["path"]["camera"], "still");
  EXPECT_GT(light["flips"], 10);
  EXPECT_GT(light["edges"]["true_world_per_second"], 0.1) << "the shadow drives with its box";
  for (const json& frame : light["by_frame"]) {
    EXPECT_GT(frame["receivers"], 1000);
    EXPECT_LT(frame["receivers"].get<int>(), 96 * 64);
  }
  const ProcessResult exact = run_gnomon(film + Words{"--technique", "izb"});
  ASSERT_EQ(exact.exit_code, 0) << exact.err;
  EXPECT_EQ(json::parse(exact.out)["lights"][0]["flips"], 0);
  EXPECT_EQ(run_gnomon(film + Words{"--path", "drive", "--move", "camera"}).exit_code, 2);
}

// At a moment of its animation the scene is the one in which all stands there, for every command.
TEST(ShimmerProgram, ShowsAMoment) {
  const TemporaryFolder folder;
  const std::string driving = folder / "driving.gltf", standing = folder / "standing.gltf";
  std::ofstream(driving) << driving_box();
  std::ofstream(standing) << driving_box(0.5);
  const Words options{"--size", "96x64", "--map-size", "64", "--json", "-"};
  const auto figures = [&](const Words& scene) {
    const ProcessResult run = run_gnomon(Words{"compare"} + scene + options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const json light = json::parse(run.out)["lights"][0];
    return json{light["pixels"], light["error"], light["classes"]};
  };
  const json moment = figures({driving, "--time", "1.25"});
  EXPECT_EQ(moment, figures({standing}));
  EXPECT_EQ(moment, figures({driving, "--time", "drive:1.25"}));
  EXPECT_NE(moment, figures({driving}));
  const std::string changing = folder / "changing.gltf";
  std::ofstream(changing) << driving_box(-2.0, true);
  EXPECT_EQ(moment, figures({changing, "--time", "1.25"})) << "by the weights of morph targets";
  EXPECT_EQ(figures({driving}), figures({changing}));
  const auto error = [&](const Words& words) {
    const ProcessResult run = run_gnomon(Words{"compare"} + words + options);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    return run.err;
  };
  EXPECT_NE(error({driving, "--time", "fly:1"}).find("no such animation or path (got fly, allowed drive)"),
            std::string::npos);
  EXPECT_NE(error({"fence", "--time", "1"}).find("moves nothing by itself"), std::string::npos);
}

// Sweeps and tune play objects as shimmer does.
TEST(ShimmerProgram, SweepsPlayObjects) {
  const TemporaryFolder folder;
  const std::string scene = folder / "driving.gltf";
  std::ofstream(scene) << driving_box();
  const Words film{scene, "--size", "96x64", "--frames", "4", "--fps", "4"};
  const ProcessResult alone = run_gnomon(Words{"shimmer"} + film + Words{"--map-size", "64", "--json", "-"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  const json light = json::parse(alone.out)["lights"][0];
  ASSERT_GT(light["flips"], 10);
  const ProcessResult swept = run_gnomon(
      Words{"sweep"} + film + Words{"--map-size", "64,128", "--measure", "shimmer", "-o", folder / "sweep"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  std::ifstream lines(folder / "sweep" + "/sweep.jsonl");
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const json cell = json::parse(line);
  EXPECT_NE(cell["command"].get<std::string>().find("--map-size 64 "), std::string::npos) << cell["command"];
  EXPECT_EQ(cell["lights"][0]["shimmer"]["flips"], light["flips"]);
  const ProcessResult both =
      run_gnomon(Words{"sweep"} + film +
                 Words{"--map-size", "64", "--measure", "shimmer", "--time", "1", "-o", folder / "both"});
  EXPECT_EQ(both.exit_code, 2) << both.err;
}

// What a scene moves by itself is played where nothing else is asked for, and by its name.
TEST(ShimmerProgram, PlaysTheScenesOwnPath) {
  const TemporaryFolder folder;
  const std::string scene = folder / "moving.json";
  std::ofstream(scene) << R"({"schema": "gnomon/scene/1", "materials": [{"name": "grey"}],
    "shapes": [{"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "grey"},
               {"sphere": {"center": [0, 1, 0], "radius": 0.5}, "material": "grey"}],
    "lights": [{"name": "sun", "type": "directional", "direction": [0.5, -1, 0.2]}],
    "camera": {"eye": [0, 2, 6], "target": [0, 0.5, 0]},
    "paths": [{"name": "past", "camera": {"eye": {"times": [0, 1], "values": [[1, 2, 6], [3, 2, 6]]}}},
              {"name": "noon", "lights": {"sun": {"direction": {"times": [0, 1], "values": [[0.5, -1, 0.2], [0, -1, 0]]}}}}]})";
  const Words film = {"shimmer",  scene, "--size", "96x64", "--map-size", "64",
                      "--frames", "4",   "--fps",  "4",     "--json",     "-"};
  const ProcessResult first = run_gnomon(film);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.err.find("path past is taken"), std::string::npos) << first.err;
  const json path = json::parse(first.out)["path"];
  EXPECT_EQ(path["name"], "past");
  EXPECT_EQ(path["camera"], "keys");
  EXPECT_EQ(path["light"], "still");
  // The keys' times are theirs; with a speed alone a built-in path is meant.
  EXPECT_EQ(run_gnomon(film + Words{"--path", "past", "--speed", "2"}).exit_code, 2);
  // What the path has no keys of would stand still.
  for (const auto& [name, move] : {std::pair{"past", "light"}, std::pair{"noon", "camera"},
                                   std::pair{"past", "both"}, std::pair{"noon", "both"}}) {
    const ProcessResult still = run_gnomon(film + Words{"--path", name, "--move", move});
    EXPECT_EQ(still.exit_code, 2) << name;
    EXPECT_NE(still.err.find(std::string("--move ") + move + ": the path has no keys of"), std::string::npos)
        << still.err;
  }
  const ProcessResult fast = run_gnomon(film + Words{"--speed", "2"});
  EXPECT_EQ(json::parse(fast.out)["path"]["camera"], "orbit") << fast.err;
  EXPECT_EQ(run_gnomon(film + Words{"--drift", "1,0"}).exit_code, 2);
  const ProcessResult noon = run_gnomon(film + Words{"--path", "noon"});
  ASSERT_EQ(noon.exit_code, 0) << noon.err;
  EXPECT_EQ(json::parse(noon.out)["path"]["light"], "keys");
  EXPECT_GT(json::parse(noon.out)["lights"][0]["edges"]["true_world_per_second"].get<double>(), 0.0);
  EXPECT_EQ(json::parse(run_gnomon(film + Words{"--path", "orbit"}).out)["path"]["camera"], "orbit");
}

// Where ffmpeg is installed a film is an MP4 of as many frames; where it is not, the call says so.
TEST(ShimmerProgram, MakesMp4ThroughFfmpeg) {
  const TemporaryFolder folder;
  const Words film = quick + Words{"--quiet", "--film", "mp4", "-o", folder / "out"};
  ProcessOptions bare;
  bare.environment = {"PATH=/nowhere"};
  expect_one_line(run_gnomon(film, bare), 2, "ffmpeg makes it, and is not installed");
  if (std::system("command -v ffmpeg > /dev/null") != 0) return;
  const ProcessResult made = run_gnomon(film);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string mp4 = read_file(folder / "out/film-0-flips.mp4");
  EXPECT_EQ(mp4.substr(4, 4), "ftyp");
  EXPECT_TRUE(read_file(folder / "out/film-0-flips.png").empty());
  EXPECT_NE(read_file(folder / "out/report.html").find("film-0-drawn.mp4"), std::string::npos);
}

// The ffmpeg of this test sends the signal itself, and ignores any.
TEST(ShimmerProgram, EndsThoughFfmpegHangs) {
  for (const auto& [signal, code] : {std::pair{"TERM", 143}, std::pair{"INT", 130}}) {
    const TemporaryFolder folder;
    write_text(folder / "ffmpeg", fmt::format("#!/bin/sh\ntrap '' INT TERM\nkill -{} $PPID\nsleep 40\n"
                                              "echo late >late\n",
                                              signal));
    std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms::owner_all);
    ProcessOptions options;
    options.folder = folder.path();
    options.environment = {"PATH=" + folder.path() + ":/usr/bin:/bin"};
    const ProcessResult result = run_gnomon(quick + Words{"--film", "mp4", "-o", "out"}, options);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(folder.entries(), Words{"ffmpeg"});
  }
}

TEST(ShimmerProgram, WrongCallsAreOneLine) {
  const Words nothing = {"--json", "-"};
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "sun"}), 2, "no path of a camera");
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "walk,sun"}), 2, "one path for each");
  expect_one_line(run_gnomon(quick + nothing + Words{"--snap", "--technique", "csm"}), 2,
                  "--technique is csm");
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "nowhere.json"}), 3, "nowhere.json");
}

}  // namespace
}  // namespace gnomon::app_test
