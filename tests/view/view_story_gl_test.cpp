// What the lab says of one pixel of a comparison, and the scene that it saves.
#include "lab/view/state/pixel_story.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lab/view/work/scene_source.h"
#include "scene/load.h"
#include "tests/support/app_process.h"
#include "tests/view/view_thread_fixture.h"

namespace gnomon::lab {
namespace {

// A hard test without any bias but the constant one shadows a pixel at its texel's centre as the drawing from the light
// says, up to the slope within the texel: so the own texel of most wrong and right pixels agrees with V5.
TEST(PixelStory, ItsLightSpaceAgreesWithTheTest) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  carry_out(state, SetMapOption{"bias", "4texel"});
  carry_out(state, SetMapOption{"slope-bias", "0"});
  lab.thread().post(1, {state.revision, state.setup});
  const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  int seen = 0, same = 0, dark = 0;
  for (int y = 0; y < lab_size.height; ++y)
    for (int x = 0; x < lab_size.width; ++x) {
      const PixelStory story = tell_story(*done->outcome, {x, y}, lab_size);
      const auto space = light_space(*done->outcome, story, 2);
      if (!compare::is_compared(story.label) || !space) continue;
      ASSERT_EQ(space->nearer.size(), 25u);
      const bool shadows = space->nearer[12] > space->bias;
      ++seen, dark += shadows, same += shadows == (story.rungs[5] < 0.5);
    }
  EXPECT_GT(dark, 20);
  EXPECT_GT(same, 0.99 * seen) << same << " of " << seen;
}

// Of every technique every pixel has a story, whose phrases are all there and filled in.
TEST(PixelStory, IsToldOfEveryPixel) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  std::set<std::string> told;
  for (const char* technique : {"hard", "pcf", "vsm", "hybrid", "izb"}) {
    carry_out(state, SetMapOption{"technique", technique});
    lab.thread().post(1, {state.revision, state.setup});
    const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
    for (int y = 0; y < lab_size.height; y += 2)
      for (int x = 0; x < lab_size.width; x += 2) {
        const PixelStory story = tell_story(*done->outcome, {x, y}, lab_size);
        ASSERT_FALSE(story.words.empty());
        ASSERT_EQ(story.words.find_first_of("{}"), std::string::npos) << story.words;
        ASSERT_EQ(story.deciding > 0, compare::has_cause(story.label));
        told.insert(story.words);
      }
  }
  const auto any = [&](std::string_view part) {
    return std::any_of(told.begin(), told.end(),
                       [&](const std::string& text) { return text.find(part) != text.npos; });
  };
  for (const char* part :
       {"Not compared: ", "The exact ray says: lit. So it is right.", "It went wrong on the step",
        "pcf reads more of the map", "surely lit, no ray was cast", "izb tests this very point"})
    EXPECT_TRUE(any(part)) << part;
}

// The page's remarks, of the page's own phrases, on what mirrors, on glass, and on what the map stores glass before.
TEST(PixelStory, RemarksOnMirrorsAndGlass) {
  Lab lab("whitted", {});
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  std::set<std::string> told;
  bool some_plain = false;
  for (int y = 0; y < lab_size.height; ++y)
    for (int x = 0; x < lab_size.width; ++x) {
      const PixelStory story = tell_story(*done->outcome, {x, y}, lab_size);
      some_plain = some_plain || (story.seen && story.remarks.empty());
      told.insert(story.remarks.begin(), story.remarks.end());
      EXPECT_TRUE(story.seen || story.remarks.empty());
      const bool own = !story.remarks.empty() && story.remarks.front().starts_with("This surface is");
      EXPECT_FALSE(own && story.words.find("exact ray says: lit") != std::string::npos) << story.words;
    }
  EXPECT_TRUE(some_plain);
  for (const char* start :
       {"This surface is glass (material “glass”). The ray-traced picture adds what is seen through it",
        "This surface is a mirror (material “mirror”). The ray-traced picture adds what is mirrored in it",
        "The texel looked up holds glass (material “glass”), which the map"})
    EXPECT_TRUE(std::any_of(told.begin(), told.end(), [&](const std::string& t) {
      return t.starts_with(start);
    })) << start;
  EXPECT_EQ(told.size(), 3u);
}

TEST(SaveScene, SaysWhatIsShown) {
  const app_test::TemporaryFolder folder;
  for (const char* name : {"floating-box", "shapes", "whitted", "penumbra", "acne"}) {
    Lab lab(name, {});
    const auto shown = lab.until(is_open);
    ViewState state = lab.state(*shown);
    carry_out(state, OrbitBy{25.0, 5.0});
    carry_out(state, PanBy{0.1, -0.2});
    carry_out(state, TurnLightBy{20.0, -3.0});
    carry_out(state, SetMapOption{"bias", "0.5texel"});
    const std::string path = folder / (std::string(name) + ".json");
    const auto written = write_scene(path, shown->scene->argument, state);
    ASSERT_TRUE(written) << name << ": " << written.error().message();
    const auto scene = load_scene(path, {.confine_paths = true});
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->camera.eye, posed_camera(state).eye) << name;
    const Light light = posed_light(state);
    EXPECT_LT(glm::length(scene->lights[0].position - light.position), 1e-12) << name;
    if (light.type != LightType::point) {
      EXPECT_LT(glm::length(scene->lights[0].direction - light.direction), 1e-12) << name;
    }
    const auto map = first_map_options({path, false});
    ASSERT_TRUE(map);
    EXPECT_EQ(map->bias.constant, 0.5) << name;
    EXPECT_EQ(map->size, 128) << name;
  }
}

// The light is in a file that the scene includes; the new file has it where it is now, and only once.
TEST(SaveScene, TakesOverTheLightsOfIncludedFiles) {
  const app_test::TemporaryFolder folder;
  write_whole(folder / "plain.json", scene_with_radius("0.5"));
  write_whole(folder / "outer.json", R"({"schema": "gnomon/scene/1", "include": ["plain.json"],
    "camera": {"eye": [0, 3, 5], "target": [0, 0, 0]}})");
  Lab lab(folder / "outer.json", {});
  const auto shown = lab.until(is_open);
  ViewState state = lab.state(*shown);
  carry_out(state, TurnLightBy{20.0, -3.0});
  carry_out(state, LightSizeTo{2.0});
  const std::string path = folder / "saved.json";
  const auto written = write_scene(path, shown->scene->argument, state);
  ASSERT_TRUE(written) << written.error().message();
  const auto scene = load_scene(path, {.confine_paths = true});
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.size(), 1u);
  EXPECT_LT(glm::length(scene->lights[0].direction - posed_light(state).direction), 1e-12);
  EXPECT_NEAR(light_size(scene->lights[0]), 2.0, 1e-12);
  EXPECT_EQ(scene->shapes.size(), 2u);
}

// What the scene includes is not in the new file's folder: the file that stands there stays.
TEST(SaveScene, AFileThatWouldNotReadAgainIsNotWritten) {
  const app_test::TemporaryFolder folder, other;
  write_whole(folder / "plain.json", scene_with_radius("0.5"));
  write_whole(folder / "outer.json", R"({"schema": "gnomon/scene/1", "include": ["plain.json"]})");
  Lab lab(folder / "outer.json", {});
  const auto shown = lab.until(is_open);
  const std::string path = other / "kept.json";
  write_whole(path, "kept");
  EXPECT_FALSE(write_scene(path, shown->scene->argument, lab.state(*shown)));
  EXPECT_EQ(app_test::read_file(path), "kept");
}

// The ending of a scene's own format in capitals.
TEST(SaveScene, AnEndingInCapitalsIsTheSameFormat) {
  const app_test::TemporaryFolder folder;
  write_whole(folder / "PLAIN.JSON", scene_with_radius("0.5"));
  Lab lab(folder / "PLAIN.JSON", {});
  const auto shown = lab.until(is_open);
  ViewState state = lab.state(*shown);
  carry_out(state, SetMapOption{"bias", "0.5texel"});
  for (const char* name : {"saved.json", "SAVED.JSON"}) {
    const std::string path = folder / name;
    const auto written = write_scene(path, shown->scene->argument, state);
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(app_test::read_file(path).find("include"), std::string::npos);
    const auto map = first_map_options({path, false});
    ASSERT_TRUE(map);
    EXPECT_EQ(map->bias.constant, 0.5) << name;
  }
}

}  // namespace
}  // namespace gnomon::lab
