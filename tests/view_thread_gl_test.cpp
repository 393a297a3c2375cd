// The thread that draws and compares for the window, without a window: any offscreen context will do. Each test waits
// for what it needs and for nothing else.
#include "app/view/render_thread.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "app/view/map_rows.h"
#include "app/view/pixel_story.h"
#include "app/view/save_scene.h"
#include "raster/shader_folder.h"
#include "scene/load.h"
#include "tests/app_process.h"

namespace gnomon::app {
namespace {

constexpr ImageSize size{64, 48};

/// A studio of its own thread, and the last snapshot that it gave.
class Lab {
 public:
  Lab(const std::string& scene, const std::string& shaders) {
    options_.compare.perceptual = false;
    options_.shader_folder = shaders;
    auto source = read_source({scene, false}, {}, options_);
    if (!source) {
      ADD_FAILURE() << source.error().message();
      return;
    }
    const auto context = [] { return raster::create_context(raster::Backend::automatic); };
    thread_ = std::make_unique<RenderThread>(context, std::move(*source), options_, [this] {
      {
        const std::lock_guard lock(mutex_);
        woken_ = true;
      }
      changed_.notify_one();
    });
  }

  /// The first snapshot of which this is true.
  template <class Condition>
  std::shared_ptr<const Snapshot> until(const Condition& condition) {
    for (;;) {
      auto snapshot = thread_->snapshot();
      if (condition(*snapshot)) return snapshot;
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return woken_; });
      woken_ = false;
    }
  }

  RenderThread& thread() { return *thread_; }

  /// A state of the scene that is open.
  ViewState state(const Snapshot& shown) const {
    ViewState state;
    state.given = shown.scene->given;
    state.setup.lights.resize(state.given.lights.size());
    state.setup.size = size;
    state.setup.map.size = 128;
    state.initial = state.setup;
    return state;
  }

 private:
  StudioOptions options_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  std::unique_ptr<RenderThread> thread_;
};

bool is_open(const Snapshot& shown) {
  return shown.scene != nullptr;
}

/// Whole under its name, or not at all.
void write(const std::string& path, const std::string& text) {
  std::ofstream(path + ".new", std::ios::binary) << text;
  std::filesystem::rename(path + ".new", path);
}

std::string own_shader(std::string_view name) {
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (file.name == name) return std::string(file.text);
  ADD_FAILURE() << "no shader " << name;
  return {};
}

constexpr const char* plain_scene = R"({"schema": "gnomon/scene/1", "name": "plain",
  "camera": {"eye": [0, 3, 5], "target": [0, 0, 0]},
  "lights": [{"name": "sun", "type": "directional", "elevation_degrees": 50, "azimuth_degrees": 30}],
  "materials": [{"name": "grey"}],
  "shapes": [{"material": "grey", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}},
             {"material": "grey", "sphere": {"center": [0, 1.5, 0], "radius": RADIUS}}]})";

std::string scene_with_radius(const char* radius) {
  std::string text = plain_scene;
  return text.replace(text.find("RADIUS"), 6, radius);
}

TEST(RenderThread, TheNewestOrderIsTheOneThatIsFinished) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  for (int i = 0; i < 20; ++i) {
    carry_out(state, TurnLightBy{1.0, 0.0});
    lab.thread().post(1, {state.revision, state.setup});
  }
  const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  EXPECT_EQ(done->outcome->labels.size, size);
  EXPECT_EQ(done->outcome->light, posed_light(state));
}

/// Some setting, light and camera.
void change_at_random(ViewState& state, std::mt19937& random) {
  const auto number = [&](double from, double to) {
    return from + (to - from) * double(random()) / double(std::mt19937::max());
  };
  using enum raster::Technique;
  constexpr std::array techniques{hard, pcf, vsm, csm};
  raster::MapOptions map;
  map.technique = techniques[random() % techniques.size()];
  map.size = 64 << random() % 3;
  map.bias.slope = number(0.0, 2.0);
  set_bias_texels(map.bias, number(0.0, 3.0), 1.0);
  carry_out(state, SetMap{map});
  carry_out(state, LightAzimuthTo{number(-180.0, 180.0)});
  carry_out(state, LightElevationTo{number(20.0, 80.0)});
  carry_out(state, OrbitTo{number(-180.0, 180.0), number(10.0, 60.0)});
  carry_out(state, PanBy{number(-0.2, 0.2), number(-0.2, 0.2)});
}

/// What `gnomon compare` makes of it, in one go.
Image<compare::Label> compared_labels(const ViewState& state, const LoadedScene& loaded,
                                      raster::Renderer& renderer) {
  place(state.given, state.setup, *loaded.scene);
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = state.setup.size;
  options.raster.map = state.setup.map;
  options.raster.runs = 1;
  const std::vector<std::uint32_t> lights{state.setup.light};
  auto comparison = compare::compare_world(*loaded.world, renderer, lights, options);
  if (comparison) return std::move(comparison->lights.front().labels);
  ADD_FAILURE() << comparison.error().message();
  return {};
}

TEST(RenderThread, LabelsAreThoseOfCompareInTwentyRandomStates) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  const auto source = read_source({"floating-box", false}, {}, {});
  ASSERT_TRUE(source);
  auto renderer = make_renderer(raster::Backend::automatic, *source->loaded);
  ASSERT_TRUE(renderer);
  std::mt19937 random(11);
  for (int i = 0; i < 20; ++i) {
    change_at_random(state, random);
    lab.thread().post(1, {state.revision, state.setup});
    const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
    EXPECT_EQ(done->outcome->comparison.lights.front().labels.data,
              compared_labels(state, *source->loaded, **renderer).data)
        << i;
  }
}

// A light that gets a size calls for soft shadows, which the scene itself has none of.
TEST(RenderThread, ALightThatGetsASizeCastsSoftShadows) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  const auto penumbra = [&] {
    lab.thread().post(1, {state.revision, state.setup});
    const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
    const Image<float>& truth = done->outcome->comparison.lights.front().rungs.front();
    return std::count_if(truth.data.begin(), truth.data.end(), [](float v) { return v > 0.0f && v < 1.0f; });
  };
  EXPECT_EQ(penumbra(), 0);
  carry_out(state, LightSizeTo{8.0});
  EXPECT_GT(penumbra(), 20);
  const auto source = read_source({"floating-box", false}, {}, {});
  ASSERT_TRUE(source);
  auto renderer = make_renderer(raster::Backend::automatic, *source->loaded);
  ASSERT_TRUE(renderer);
  const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  EXPECT_EQ(done->outcome->comparison.lights.front().labels.data,
            compared_labels(state, *source->loaded, **renderer).data);
  carry_out(state, LightSizeTo{0.0});
  EXPECT_EQ(penumbra(), 0);
}

TEST(RenderThread, WhatCannotBeDrawnLeavesThePictureThatWasThere) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto good = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  carry_out(state, SetMapOption{"map-size", "65536"});
  lab.thread().post(1, {state.revision, state.setup});
  const auto bad = lab.until([](const Snapshot& shown) { return shown.undrawable.has_value(); });
  EXPECT_EQ(bad->undrawable->revision, state.revision);
  EXPECT_EQ(bad->live.picture, good->live.picture);
  EXPECT_EQ(bad->outcome, good->outcome);
}

TEST(RenderThread, AChangedSceneIsReadAgainAndABrokenOneIsSaid) {
  const app_test::TemporaryFolder folder;
  const std::string path = folder / "plain.json";
  write(path, scene_with_radius("0.5"));
  Lab lab(path, {});
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto small = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  write(path, scene_with_radius("1.25"));
  const auto again = lab.until([](const Snapshot& shown) { return shown.scene->number == 2; });
  EXPECT_TRUE(again->scene->again);
  EXPECT_NE(again->live.picture->data, small->live.picture->data);
  write(path, "{ this is no scene");
  const auto broken = lab.until([](const Snapshot& shown) { return shown.unreadable.has_value(); });
  EXPECT_NE(broken->unreadable->file.find("plain.json"), std::string::npos);
  EXPECT_EQ(broken->scene->number, 2u);  // its exposure may be that of a comparison that has ended since
  EXPECT_NE(broken->live.picture->data, small->live.picture->data);
  write(path, scene_with_radius("0.75"));
  const auto mended = lab.until([](const Snapshot& shown) { return shown.scene->number == 3; });
  EXPECT_FALSE(mended->unreadable);
}

TEST(RenderThread, AShaderThatDoesNotCompileLeavesTheLastGoodPicture) {
  const app_test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "technique");
  const std::string path = folder / "technique/hard.glsl", own = own_shader("technique/hard.glsl");
  write(path, own + "// mine\n");
  Lab lab("floating-box", folder.path());
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto good = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  write(path, own + "float mistake = ;\n");
  const auto broken = lab.until([](const Snapshot& shown) { return shown.unreadable.has_value(); });
  EXPECT_NE(broken->unreadable->message().find("hard.glsl"), std::string::npos)
      << broken->unreadable->message();
  EXPECT_EQ(broken->live.picture->data, good->live.picture->data);
  write(path, own + "// mine once more\n");
  const auto mended = lab.until([](const Snapshot& shown) { return shown.scene->number == 2; });
  EXPECT_FALSE(mended->unreadable);
}

TEST(RenderThread, AnotherSceneBringsItsOwnSettings) {
  Lab lab("floating-box", {});
  lab.until(is_open);
  lab.thread().open({"peter-panning", false});
  const auto shown = lab.until([](const Snapshot& now) { return now.scene && now.scene->number == 2; });
  EXPECT_FALSE(shown->scene->again);
  EXPECT_NE(shown->scene->map, raster::MapOptions{});
  lab.thread().open({"no-such-scene", false});
  EXPECT_TRUE(lab.until([](const Snapshot& now) { return now.unreadable.has_value(); })->scene->number == 2);
}

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
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const PixelStory story = tell_story(*done->outcome, {x, y}, size);
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
    for (int y = 0; y < size.height; y += 2)
      for (int x = 0; x < size.width; x += 2) {
        const PixelStory story = tell_story(*done->outcome, {x, y}, size);
        ASSERT_FALSE(story.words.empty());
        ASSERT_EQ(story.words.find_first_of("{}"), std::string::npos) << story.words;
        ASSERT_EQ(story.deciding > 0, compare::is_wrong(story.label));
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
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const PixelStory story = tell_story(*done->outcome, {x, y}, size);
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
  write(folder / "plain.json", scene_with_radius("0.5"));
  write(folder / "outer.json", R"({"schema": "gnomon/scene/1", "include": ["plain.json"],
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

}  // namespace
}  // namespace gnomon::app
