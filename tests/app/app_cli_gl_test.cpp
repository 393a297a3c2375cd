// The program from outside: exit codes, what goes to stdout and to stderr, what is left on the disk.
// Pictures are small here: what they show is other tests' matter.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/app_process.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

// --- Data on stdout
// ------------------------------------------------------------------------------------------

TEST(Json, ScenesAndPlanArePure) {
  const json scenes = json::parse(run_gnomon({"scenes", "--json", "-"}).out);
  EXPECT_GE(scenes["scenes"].size(), 7u);
  for (const json& scene : scenes["scenes"]) {
    const ProcessResult plan = run_gnomon({"plan", scene["name"], "--json", "-"});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    const json document = json::parse(plan.out);
    const json& effects = document["effects"];
    EXPECT_EQ(effects.size(), 15u);
    std::uint64_t total = document["rays"]["primary"];
    for (const json& effect : effects) total += effect["rays"].get<std::uint64_t>();
    EXPECT_EQ(document["rays"]["total"], total);
    EXPECT_EQ(document["rays"]["primary"], 1280u * 720u);
    for (const char* rays : {"primary", "receivers", "shadow"}) {
      EXPECT_FALSE(document["tracer"][rays]["way"].get<std::string>().empty());
      EXPECT_FALSE(document["tracer"][rays]["reason"].get<std::string>().empty());
    }
    EXPECT_EQ(document["instances"]["way"], scene["name"] == "forest" ? "kept" : "flattened")
        << scene["name"];
    EXPECT_FALSE(document["instances"]["reason"].get<std::string>().empty());
    for (const json& effect : effects) {
      EXPECT_TRUE(effect["simulated"] || effect["rays"] == 0);
      EXPECT_TRUE(effect["simulated"].is_boolean() && effect["called_for"].is_boolean());
      EXPECT_FALSE(effect["reason"].get<std::string>().empty());
    }
  }
}

TEST(Json, OnStdoutAloneWritesNoFolder) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_gnomon(Words{"compare", "acne-floor", "--json", "-"} + small, {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["schema"], "gnomon/result/1");
  EXPECT_TRUE(folder.entries().empty());
}

TEST(Json, CompareGivesTheBytesOfItsResultFile) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(
      Words{"compare", "acne-floor", "--bias", "0", "--seed", "7", "--json", "-", "-o", "out"} + small,
      {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, read_file(folder / "out/result.json"));
  const json document = json::parse(result.out);
  EXPECT_EQ(document["schema"], "gnomon/result/1");
  EXPECT_EQ(document["seed"], 7);
  EXPECT_EQ(
      document["command"],
      "gnomon compare acne-floor --bias 0 --seed 7 --json - -o out --size 64x36 --map-size 128 --runs 1");
  EXPECT_GT(document["lights"][0]["classes"]["acne"], 0);
}

json without_times(json document) {
  for (const char* timed : {"times_ms", "process", "time_budget"}) document.erase(timed);
  document.erase("command");
  document.erase("threads");
  document["machine"].erase("load");
  for (json& light : document["lights"]) light.erase("times_ms");
  return document;
}

TEST(Json, TheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<json> results;
  for (const char* threads : {"1", "2", "2"}) {
    const ProcessResult result = run_gnomon(
        Words{"compare", "fence", "--threads", threads, "--json", "-"} + small, {.folder = folder.path()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    results.push_back(json::parse(result.out));
    EXPECT_EQ(results.back()["threads"], std::stoi(threads));
  }
  EXPECT_EQ(without_times(results[0]), without_times(results[1]));
  EXPECT_EQ(without_times(results[1]), without_times(results[2]));
}

TEST(Streams, TableOnStdoutMessagesOnStderrNothingWhenQuiet) {
  const TemporaryFolder folder;
  const Words words = Words{"compare", "acne-floor"} + small;
  const ProcessResult loud = run_gnomon(words, {.folder = folder.path()});
  EXPECT_EQ(loud.exit_code, 0);
  EXPECT_NE(loud.out, "");
  EXPECT_NE(loud.out.find("\nReport: out/acne-floor/report.html\n"), std::string::npos) << loud.out;
  EXPECT_NE(loud.err.find(" MB of memory at most"), std::string::npos) << loud.err;
  EXPECT_EQ(loud.err.find('\r'), std::string::npos) << "a progress line off a terminal";
  EXPECT_EQ(loud.out.find('\033'), std::string::npos) << "colour off a terminal";
  const ProcessResult quiet = run_gnomon(words + Words{"--quiet"}, {.folder = folder.path()});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

// --- Outputs
// -------------------------------------------------------------------------------------------------

TEST(Outputs, CompareWritesItsFolderAndNothingElse) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(
      Words{"compare", "acne-floor", "-o", "a/b", "--aov", "a/all.exr", "--json", "a/copy.json", "-q"} +
          small,
      {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> entries = folder.entries();
  for (const char* name :
       {"a/b/report.html", "a/b/result.json", "a/b/result.csv", "a/all.exr", "a/copy.json"}) {
    EXPECT_TRUE(std::binary_search(entries.begin(), entries.end(), name)) << name;
  }
  for (const std::string& entry : entries) {
    EXPECT_EQ(entry.find(".tmp"), std::string::npos) << "left behind: " << entry;
    EXPECT_EQ(entry.find(".gnomon-"), std::string::npos) << "left behind: " << entry;
  }
}

Words exr_channels(const std::string& path) {
  const auto file = OIIO::ImageInput::open(path);
  if (!file) return {};
  EXPECT_EQ(file->spec().width, 64);
  EXPECT_EQ(file->spec().height, 36);
  EXPECT_EQ(file->spec().format, OIIO::TypeDesc::FLOAT);
  return {file->spec().channelnames.begin(), file->spec().channelnames.end()};
}

void expect_channels(const std::string& path, const Words& wanted) {
  const Words channels = exr_channels(path);
  for (const std::string& name : wanted) {
    EXPECT_EQ(std::count(channels.begin(), channels.end(), name), 1) << name << " in " << path;
  }
}

TEST(Outputs, PicturesArePngOrExrWithRecords) {
  const TemporaryFolder folder;
  const ProcessOptions here{.folder = folder.path()};
  EXPECT_EQ(run_gnomon({"raster", "acne-floor", "--size", "64x36", "-o", "r.png"}, here).exit_code, 0);
  EXPECT_EQ(run_gnomon({"raster", "acne-floor", "--size", "64x36", "-o", "r.exr"}, here).exit_code, 0);
  EXPECT_EQ(run_gnomon({"raytrace", "acne-floor", "--size", "64x36", "-o", "t.png"}, here).exit_code, 0);
  EXPECT_EQ(run_gnomon({"raytrace", "acne-floor", "--size", "64x36", "-o", "t.exr"}, here).exit_code, 0);
  EXPECT_EQ(folder.entries(), (Words{"r.exr", "r.png", "t.exr", "t.png"}));
  for (const char* name : {"r.png", "t.png"}) {
    const auto file = OIIO::ImageInput::open(folder / name);
    ASSERT_TRUE(file) << name;
    EXPECT_EQ(file->spec().width, 64);
    EXPECT_EQ(file->spec().nchannels, 3);
  }
  expect_channels(folder / "r.exr", {"R", "G", "B", "object.V", "primitive.V", "drawn.V", "gap.V",
                                     "texel_uv.U", "texel_uv.V", "distance.V"});
  expect_channels(folder / "t.exr", {"R", "G", "B", "Z", "position.X", "position.Y", "position.Z", "normal.X",
                                     "normal.Y", "normal.Z", "object.V", "primitive.V", "truth.V"});
}

TEST(Outputs, AFolderThatIsNotThereIsMade) {
  const TemporaryFolder folder;
  for (const Words& words :
       {Words{"raster", "acne-floor", "-o", "a/b/r.png"}, Words{"raytrace", "acne-floor", "-o", "c/d/t.png"},
        Words{"raytrace", "acne-floor", "--heatmap", "nodes", "-o", "e/f/h.png"}}) {
    const ProcessResult result =
        run_gnomon(words + Words{"--size", "64x36", "-q"}, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder / words.back()));
  }
}

TEST(Outputs, WhatCannotBeWrittenIsToldBeforeTheWork) {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  const std::vector<Words> wrong = {{"compare", "acne-floor", "-o", "file"},
                                    {"compare", "acne-floor", "-o", "file/below"},
                                    {"compare", "acne-floor", "--aov", "file/a.exr"},
                                    {"compare", "acne-floor", "--json", "file/a.json"},
                                    {"compare", "acne-floor", "--json", folder.path()},
                                    {"raster", "acne-floor", "-o", "file/a.png"},
                                    {"raytrace", "acne-floor", "-o", "file/a.exr"},
                                    {"raster", "acne-floor", "--json", "file/a.json"},
                                    {"raytrace", "acne-floor", "--json", "file/a.json"},
                                    {"plan", "acne-floor", "--json", "file/a.json"},
                                    {"scenes", "--json", "file/a.json"}};
  for (const Words& words : wrong) {
    expect_one_line(run_gnomon(words, {.folder = folder.path()}), 4, "cannot write here");
    EXPECT_EQ(folder.entries(), Words{"file"}) << words.back();
  }
  EXPECT_EQ(run_gnomon({"scenes"}, {.out_path = "/dev/full"}).exit_code, 4);
}

void expect_valid(const std::string& text) {
  SchemaCheck check(
      json::parse(std::ifstream(gnomon::test::source_dir() + "/app/outputs/render.schema.json")));
  EXPECT_EQ(check.violations(json::parse(text)), std::vector<std::string>{}) << text;
}

TEST(Outputs, RasterAndRaytraceTellWhatTheyDid) {
  const TemporaryFolder folder;
  const Words raster{"raster", "fence",      "--size", "64x36",       "-o",
                     "r.png",  "--map-size", "128",    "--technique", "pcf"};
  const ProcessResult drawn = run_gnomon(raster + Words{"--json", "-"}, {.folder = folder.path()});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  expect_valid(drawn.out);
  const json r = json::parse(drawn.out);
  EXPECT_EQ(r.at("renderer"), "shadow mapping");
  EXPECT_EQ(r.at("map").at("technique"), "pcf");
  EXPECT_EQ(r.at("map").at("size"), 128);
  EXPECT_GE(r.at("costs").at("map_texels"), 128 * 128);
  EXPECT_EQ(r.at("lights").at(0).at("times_ms").at("shade_pass").at("runs").size(), 1u);

  const Words raytrace{"raytrace", "orchard", "--size", "64x36", "-o", "t.exr", "--accel", "two-level"};
  const ProcessResult traced = run_gnomon(raytrace + Words{"--json", "t.json"}, {.folder = folder.path()});
  ASSERT_EQ(traced.exit_code, 0) << traced.err;
  EXPECT_EQ(traced.out, "");
  expect_valid(read_file(folder / "t.json"));
  const json t = json::parse(read_file(folder / "t.json"));
  EXPECT_EQ(t.at("renderer"), "ray tracing");
  EXPECT_EQ(t.at("accel").at("name"), "two-level");
  EXPECT_EQ(t.at("costs").at("primary_rays"), 64 * 36);
  EXPECT_GT(t.at("lights").at(0).at("shadow_rays"), 0);
  EXPECT_EQ(t.at("picture"), "t.exr");
  EXPECT_EQ(folder.entries(), (Words{"r.png", "t.exr", "t.json"}));

  const ProcessResult both =
      run_gnomon(Words{"raytrace", "fence", "--heatmap", "nodes", "--json", "-"}, {.folder = folder.path()});
  expect_one_line(both, 2, "--json: a heat map has none");
}

// A broken installation: the library that the module for image files needs is no library.
TEST(Outputs, AnInternalErrorIsExitCode6) {
  const TemporaryFolder folder;
  const std::string module = read_file(gnomon::test::image_module());
  const std::string prefix = "libOpenImageIO.so";
  const std::size_t at = module.find(prefix);
  ASSERT_NE(at, std::string::npos);
  const std::string library = module.c_str() + at;  // ends with a zero byte in the module's table of strings
  write_text(folder / library, "");
  write_text(folder / "v.tga", "");
  write_text(
      folder / "capture.json",
      R"({"schema": "gnomon/capture/1", "renderer": {"name": "x"}, "scene": "thin-wall", "size": [64, 36],
                 "visibility": "v.tga"})");
  const ProcessResult result =
      run_gnomon({"judge", "capture.json"},
                 {.folder = folder.path(), .environment = {"LD_LIBRARY_PATH=" + folder.path()}});
  expect_one_line(result, 6, "cannot load the module for image files: ");
  EXPECT_EQ(folder.entries(), (Words{"capture.json", library, "v.tga"}));
}

TEST(Outputs, BadInputLeavesNothing) {
  const TemporaryFolder folder;
  write_text(folder / "broken.json", "{\n  \"camera\": {\"eye\": [0, 1,\n}");
  const ProcessResult broken = run_gnomon({"compare", "broken.json"}, {.folder = folder.path()});
  expect_one_line(broken, 3, "broken.json:3:");
  const ProcessResult absent = run_gnomon({"compare", "absent.json"}, {.folder = folder.path()});
  expect_one_line(absent, 3, "absent.json");
  expect_one_line(run_gnomon({"compare", "fense"}, {.folder = folder.path()}), 3, "fence");
  EXPECT_EQ(folder.entries(), Words{"broken.json"});
}

// --- The other exit codes
// ------------------------------------------------------------------------------------

TEST(ExitCodes, ThresholdExceeded) {
  const TemporaryFolder folder;
  const ProcessOptions here{.folder = folder.path()};
  const Words acne = Words{"compare", "acne-floor", "--bias", "0"} + small;
  EXPECT_EQ(run_gnomon(acne + Words{"--fail-above", "0.1%"}, here).exit_code, 1);
  EXPECT_EQ(run_gnomon(acne + Words{"--fail-above", "100%"}, here).exit_code, 0);
}

TEST(ExitCodes, ABareOneIsNoLimit) {
  for (const char* limit : {"1", "wrong:1"})
    expect_one_line(run_gnomon({"compare", "acne-floor", "--fail-above", limit}), 2,
                    "gnomon compare: --fail-above: 1 is all, and may be meant as one per cent (got ");
  expect_one_line(run_gnomon({"tune", "acne-floor", "--max-error", "1"}), 2, "(got 1, allowed 1% or 0.01, ");
}

// A floor under slats narrower than the filter: grey all over, where it is striped in truth.
constexpr const char* striped_floor = R"({"schema": "gnomon/scene/1", "name": "stripes",
  "camera": {"eye": [0, 3, 0.01], "target": [0, 0, 0], "up": [0, 0, -1], "vertical_fov_degrees": 30},
  "lights": [{"name": "sun", "type": "directional", "direction": [0, -1, 0]}],
  "materials": [{"name": "m", "diffuse": [0.6, 0.6, 0.6]}],
  "meshes": [{"name": "box", "generate": {"kind": "box"}}],
  "instances": [{"name": "slat", "mesh": "box", "material": "m", "translate": [0, 5, 0],
                 "scale": [0.05, 0.02, 8], "repeat": {"count": [64, 1], "spacing": [0.1, 1]}}],
  "shapes": [{"name": "floor", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "m"}]})";

TEST(ExitCodes, AStripedFloorThatIsDrawnGreyIsNotRight) {
  const TemporaryFolder folder;
  const ProcessOptions here{.folder = folder.path()};
  write_text(folder / "stripes.json", striped_floor);
  const Words grey{"compare",
                   "stripes.json",
                   "--size",
                   "160x90",
                   "--map-size",
                   "1024",
                   "--technique",
                   "pcf",
                   "--filter-radius",
                   "5",
                   "--bias",
                   "0.05",
                   "--fail-above",
                   "1%",
                   "-o",
                   "out"};
  const ProcessResult result = run_gnomon(grey, here);
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_NE(result.out.find(" % on average"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("that is more than --fail-above 1%"), std::string::npos) << result.err;
  const json document = json::parse(read_file(folder / "out/result.json"));
  EXPECT_GT(document["lights"][0]["error"]["mean_absolute"], 0.3);
  EXPECT_LT(document["lights"][0]["error"]["wrong_fraction"], 0.05);
  EXPECT_EQ(document["fail_above"]["threshold"], "1%");
  EXPECT_EQ(document["fail_above"]["failed"], true);
  Words only_wrong = grey;
  only_wrong[only_wrong.size() - 3] = "wrong:10%";
  EXPECT_EQ(run_gnomon(only_wrong, here).exit_code, 0);
}

// A light at a box's corner: for more than half of the pixels no ray to it can be decided.
TEST(ExitCodes, UncertainPixelsAreHeldAgainstTheThreshold) {
  const TemporaryFolder folder;
  write_text(folder / "corner.json", R"({"schema": "gnomon/scene/1", "name": "corner",
    "camera": {"eye": [3, 3, 5], "target": [0, 0.5, 0], "up": [0, 1, 0], "vertical_fov_degrees": 40},
    "lights": [{"name": "L", "type": "point", "position": [0.5, 1.0, 0.5], "intensity": [20, 20, 20]}],
    "materials": [{"name": "m", "diffuse": [0.6, 0.6, 0.6]}],
    "meshes": [{"name": "box", "generate": {"kind": "box"}}],
    "instances": [{"name": "b", "mesh": "box", "material": "m", "translate": [0, 0.5, 0]}],
    "shapes": [{"name": "g", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "m"}]})");
  const Words words{"compare", "corner.json", "--size", "160x90",       "--map-size",
                    "256",     "--technique", "hybrid", "--fail-above", "1%"};
  const ProcessResult result = run_gnomon(words, {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_NE(result.err.find("are uncertain, more than --fail-above 1%"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("uncertain: the truth there"), std::string::npos) << result.out;
}

TEST(ExitCodes, AMapBeyondTheContextsLimit) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(
      {"compare", "acne-floor", "--size", "64x36", "--map-size", "65536", "-q"}, {.folder = folder.path()});
  expect_one_line(result, 5, "65536");
  EXPECT_TRUE(folder.entries().empty());
}

TEST(ExitCodes, APictureWhoseSmallestBandsAreTooLarge) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_gnomon({"compare", "acne-floor", "--size", "16384x16384", "--memory", "100M", "-q"},
                 {.folder = folder.path()});
  expect_one_line(result, 5, "--memory: too little for a picture of 16384x16384 (got 100M, allowed ");
  expect_one_line(
      run_gnomon(Words{"compare", "fence", "--memory", "3M", "-q"} + small, {.folder = folder.path()}), 5,
      "the scene's textures take too much memory (got 1024x1024 pixels here, 4 MB; allowed 3M by "
      "--memory for all of them)");
  EXPECT_TRUE(folder.entries().empty());
}

// A limit that is too little is told by the user's own words, and the one that is told instead is enough.
TEST(ExitCodes, TheMemoryThatIsAskedForSuffices) {
  const TemporaryFolder folder;
  const Words words{"raytrace", "fence", "--size", "2000x1000", "-o", "x.png"};
  const ProcessResult refused =
      run_gnomon(words + Words{"--memory", "1.5m", "-q"}, {.folder = folder.path()});
  expect_one_line(refused, 5, "--memory: too little for a picture of 2000x1000 (got 1.5m, allowed ");
  const std::size_t from = refused.err.find("allowed ") + 8, to = refused.err.find(" and more");
  ASSERT_LT(from, to) << refused.err;
  const std::string enough = refused.err.substr(from, to - from);
  EXPECT_EQ(run_gnomon(words + Words{"--memory", enough, "-q"}, {.folder = folder.path()}).exit_code, 0)
      << refused.err;
}

TEST(ExitCodes, Interrupted) {
  const TemporaryFolder folder;
  // Far more work than the time before the signal allows.
  const ProcessResult result = run_gnomon({"compare", "fence", "--size", "4096x4096", "--runs", "9"},
                                          {.folder = folder.path(), .interrupt_after_ms = 300});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_NE(result.err.find("interrupted"), std::string::npos);
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace gnomon::app_test
