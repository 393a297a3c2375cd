// A scene of very many lights: the strongest few are compared, a note says so, and what --light names is among them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

using Json = nlohmann::ordered_json;

/// Over a floor, seen from +z.
std::string scene_under(const Json& lights) {
  return Json{{"schema", "gnomon/scene/1"},
              {"camera", {{"eye", {0, 3, 6}}, {"target", {0, 0, 0}}}},
              {"lights", lights},
              {"materials", {{{"name", "grey"}}}},
              {"shapes",
               {{{"plane", {{"point", {0, 0, 0}}, {"normal", {0, 1, 0}}}}, {"material", "grey"}},
                {{"sphere", {{"center", {0, 1, 0}}, {"radius", 0.5}}}, {"material", "grey"}}}}}
      .dump();
}

/// `count` lamps over a floor, named l0, l1, ...; every 50th is a hundred times as bright as the others.
std::string lamps(int count) {
  Json lights = Json::array();
  for (int i = 0; i < count; ++i) {
    const double strength = i % 50 == 0 ? 10.0 : 0.1;
    lights.push_back({{"name", fmt::format("l{}", i)},
                      {"type", "point"},
                      {"position", {0.01 * i - 2.0, 2.0, 0.5}},
                      {"intensity", {strength, strength, strength}}});
  }
  return scene_under(lights);
}

/// One behind what the scene's own camera looks at, and one behind that camera.
std::string two_lamps() {
  Json lights = Json::array();
  for (const auto& [name, z] : {std::pair("north", -8.0), std::pair("south", 8.0)})
    lights.push_back(
        {{"name", name}, {"type", "point"}, {"position", {0.0, 0.3, z}}, {"intensity", {10.0, 10.0, 10.0}}});
  return scene_under(lights);
}

std::vector<std::string> compared(const TemporaryFolder& folder, const Words& more, const std::string& note) {
  const ProcessResult result =
      run_gnomon(Words{"compare", "lamps.json", "--json", "-"} + more + small, {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("note: ") != std::string::npos, !note.empty()) << result.err;
  EXPECT_NE(result.err.find(note), std::string::npos) << result.err;
  const Json json = Json::parse(result.out, nullptr, false);
  if (!json.is_object()) return {};
  EXPECT_EQ(json["scene"]["notes"].dump().find(note) != std::string::npos, true) << "on the page, too";
  std::vector<std::string> names;
  for (const Json& light : json["lights"]) names.push_back(light["light"]["name"]);
  return names;
}

TEST(ManyLights, TheStrongestAreCompared) {
  const TemporaryFolder folder;
  write_text(folder / "lamps.json", lamps(400));
  const Words bright{"l0", "l50", "l100", "l150", "l200", "l250", "l300", "l350"};
  EXPECT_EQ(compared(folder, {}, "400 lights: the 8 that would light most"), bright);
  const Words two = compared(folder, {"--max-lights", "2"}, "400 lights: the 2 that");
  ASSERT_EQ(two.size(), 2u);
  for (const std::string& name : two) EXPECT_TRUE(std::count(bright.begin(), bright.end(), name)) << name;
  EXPECT_EQ(compared(folder, {"--light", "l77"}, "and those named"), Words{"l77"});
  expect_one_line(run_gnomon({"compare", "lamps.json", "--light", "lamp"}, {.folder = folder.path()}), 2,
                  "and 384 more");
}

TEST(ManyLights, APictureHasAllUnlessAskedForFewer) {
  const TemporaryFolder folder;
  write_text(folder / "lamps.json", lamps(70));
  const Words picture{"lamps.json", "--json", "-", "-o", "p.exr", "--size", "32x18"};
  for (const Words& command : {Words{"raster", "--map-size", "16"}, Words{"raytrace"}}) {
    const auto lights = [&](const Words& more, const std::string& note) {
      const ProcessResult result = run_gnomon(command + picture + more, {.folder = folder.path()});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_NE(result.err.find(note), std::string::npos) << result.err;
      const Json json = Json::parse(result.out, nullptr, false);
      return json.is_object() ? json["lights"].size() : 0;
    };
    EXPECT_EQ(lights({}, "all 70 lights are drawn"), 70u) << command.front();
    EXPECT_EQ(lights({"--max-lights", "2"}, "70 lights: the 2 that would light most"), 2u) << command.front();
  }
}

TEST(ManyLights, CommandsThatAreMadeAgainRepeatTheirNumber) {
  const TemporaryFolder folder;
  write_text(folder / "lamps.json", lamps(12));
  const auto out = [&](const Words& words) {
    const ProcessResult result =
        run_gnomon(words + Words{"--max-lights", "1", "--size", "48x27"}, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("12 lights: the 1 that would light most"), std::string::npos) << result.err;
    return result.out;
  };
  EXPECT_NE(out({"tune", "lamps.json", "--max-error", "90%", "--technique", "hard", "--map-size", "64"})
                .find("--max-lights 1"),
            std::string::npos);
  out({"sweep", "lamps.json", "--map-size", "32", "-o", "s"});
  EXPECT_NE(read_file(folder / "s/sweep.jsonl").find("--max-lights 1"), std::string::npos);
  const Json film = Json::parse(
      out({"shimmer", "lamps.json", "--frames", "2", "--map-size", "32", "--json", "-"}), nullptr, false);
  ASSERT_TRUE(film.is_object());
  EXPECT_EQ(film["lights"].size(), 1u);
}

// Not by the scene's own, where another one is asked for.
TEST(ManyLights, TheStrongestAreThoseThatThePosedCameraSees) {
  const TemporaryFolder folder;
  write_text(folder / "two.json", two_lamps());
  const auto out = [&](const Words& words, const Words& more) {
    const ProcessResult result = run_gnomon(
        words + Words{"two.json", "--max-lights", "1", "--size", "40x30"} + more, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  const Words from_behind{"--camera-orbit", "180,27"}, map{"--map-size", "32"};
  const auto of_compare = [&](const Words& more) {
    const Json json = Json::parse(out({"compare", "--json", "-", "--runs", "1"}, map + more), nullptr, false);
    return json.is_object() ? json["lights"][0]["light"]["name"].get<std::string>() : std::string();
  };
  EXPECT_EQ(of_compare({}), "north");
  EXPECT_EQ(of_compare(from_behind), "south");
  const auto is_of_south = [](const std::string& json) {
    return json.find("\"south\"") != std::string::npos;
  };
  EXPECT_TRUE(is_of_south(out({"raytrace", "--json", "-", "-o", "p.exr"}, from_behind)));
  EXPECT_TRUE(is_of_south(out({"shimmer", "--frames", "2", "--json", "-"}, map + from_behind)));
  EXPECT_TRUE(is_of_south(
      out({"tune", "--technique", "hard", "--max-error", "90%", "--json", "-"}, map + from_behind)));
  out({"sweep", "-o", "s"}, map + from_behind);
  EXPECT_TRUE(is_of_south(read_file(folder / "s/sweep.jsonl")));
}

// Each cell has those that `compare` with its camera has.
TEST(ManyLights, EveryCellOfASweepHasItsOwn) {
  const TemporaryFolder folder;
  write_text(folder / "two.json", two_lamps());
  const Words words{"two.json", "--max-lights", "1", "--size", "40x30", "--map-size", "32"};
  const auto run = [&](const Words& command) {
    const ProcessResult result = run_gnomon(command, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  run(Words{"sweep"} + words + Words{"--camera-orbit", "0,27/180,27/1,27", "-o", "s"});
  std::istringstream cells(read_file(folder / "s/sweep.jsonl"));
  for (const auto& [orbit, name] :
       {std::pair("0,27", "north"), std::pair("180,27", "south"), std::pair("1,27", "north")}) {
    std::string line;
    ASSERT_TRUE(std::getline(cells, line));
    const Json cell = Json::parse(line),
               alone = Json::parse(run(Words{"compare"} + words +
                                       Words{"--camera-orbit", orbit, "--json", "-", "--runs", "1"}));
    ASSERT_EQ(cell["lights"].size(), 1u);
    EXPECT_EQ(cell["lights"][0]["light"]["name"], name);
    EXPECT_EQ(cell["lights"][0]["classes"], alone["lights"][0]["classes"]) << orbit;
    EXPECT_EQ(cell["lights"][0]["error"]["wrong"], alone["lights"][0]["error"]["wrong"]) << orbit;
  }
}

TEST(ManyLights, TheForecastOfMemoryIsOfThoseThatAreCompared) {
  const TemporaryFolder folder;
  const auto bytes = [&](int count) {
    write_text(folder / "lamps.json", lamps(count));
    const ProcessResult result =
        run_gnomon({"plan", "lamps.json", "--size", "40x30", "--json", "-"}, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json json = Json::parse(result.out, nullptr, false);
    return json.is_object() ? json["memory"]["compare"]["bytes"].get<double>() : 0.0;
  };
  EXPECT_GT(bytes(8), bytes(7));
  EXPECT_EQ(bytes(100), bytes(8));
}

TEST(ManyLights, OfFewNoneIsLeftOut) {
  const TemporaryFolder folder;
  write_text(folder / "lamps.json", lamps(8));
  EXPECT_EQ(compared(folder, {}, "").size(), 8u);
}

}  // namespace
}  // namespace gnomon::app_test
