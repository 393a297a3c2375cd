// The thread that draws and compares for the window, without a window: any offscreen context will do. Each test waits
// for what it needs and for nothing else.
#include "app/console.h"
#include "lab/view/work/render_thread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <random>
#include <set>
#include <thread>

#include "lab/view/state/presets.h"
#include "lab/view/state/projection.h"
#include "raster/programs/shader_folder.h"
#include "tests/support/app_process.h"
#include "tests/view/view_thread_fixture.h"

namespace gnomon::lab {
namespace {

std::string own_shader(std::string_view name) {
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (file.name == name) return std::string(file.text);
  ADD_FAILURE() << "no shader " << name;
  return {};
}

/// The comparison of a preset's setting, with the bias that it asks for.
std::shared_ptr<const Snapshot> shown_by(Lab& lab, ViewState state, const Preset& preset) {
  const auto done = [&] {
    lab.thread().post(1, {state.revision, state.setup});
    return lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  };
  carry_out(state, SetMap{preset.apply(state.setup.map)});
  auto shown = done();
  if (preset.lost_share == 0.0) return shown;
  const compare::Comparison& c = shown->outcome->comparison;
  raster::MapOptions map = state.setup.map;
  map.bias.constant =
      std::max(map.bias.constant, losing_bias_texels(c.raster.lights[0], c.lights[0], preset.lost_share));
  carry_out(state, SetMap{map});
  return done();
}

// Cascades follow the camera, but for one that is frozen: they stay to the last bit, and all that is compared is theirs.
TEST(FrozenCamera, KeepsTheMapsWhereTheyAre) {
  Lab lab("courtyard", {});
  ViewState state = lab.state(*lab.until(is_open));
  state.setup.map.technique = raster::Technique::csm;
  const auto laid = [&] {
    lab.thread().post(1, {state.revision, state.setup});
    const auto shown = lab.until([&](const Snapshot& s) { return s.is_done(state); });
    const LightView compared = shown->outcome->comparison.raster.lights[0].map.view;
    EXPECT_EQ(frustum_edges(compared), frustum_edges(shown->live.map));
    EXPECT_EQ(shown->live.map_camera.has_value(), state.setup.map_camera.has_value());
    return frustum_edges(shown->live.map);
  };
  const auto own = laid();
  carry_out(state, FreezeMaps{});
  EXPECT_EQ(laid(), own);
  carry_out(state, OrbitBy{30.0, 10.0});
  EXPECT_EQ(laid(), own);
  carry_out(state, FreezeMaps{true});
  EXPECT_EQ(laid(), own) << "it is frozen already";
  carry_out(state, FreezeMaps{false});
  EXPECT_NE(laid(), own);
}

// By the labels of the pixels. Nothing can cast a shadow on the acne floor: it shows acne alone. What the wires' filter lets
// through is blur, and no leak.
TEST(ViewPresets, ShowTheirArtifactOnEveryScene) {
  for (const std::string scene :
       {"fence", "acne-floor", "floating-box", "thin-wall", "wires", "sphere-plane", "penumbra"}) {
    Lab lab(scene, {});
    ViewState state = lab.state(*lab.until(is_open));
    state.setup.size = {128, 96};
    for (const Preset& preset : presets()) {
      const auto shown = shown_by(lab, state, preset);
      const double share = shown_share(preset, shown->outcome->comparison.lights[0]);
      const bool is_leak = &preset == &presets()[3];
      const bool casts =
          (scene != "acne-floor" || &preset == &presets()[0]) && !(scene == "wires" && is_leak);
      EXPECT_TRUE(!is_leak || preset.labels.size() == 1u) << "the share said is that of the table's label";
      EXPECT_EQ(share > (preset.lost_share > 0.0 ? 0.01 : 0.001), casts)
          << preset.title << " on " << scene << ": " << share;
      state.revision += 10;  // the next order is a newer one
    }
  }
}

TEST(RenderThread, TheNewestOrderIsTheOneThatIsFinished) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  for (int i = 0; i < 20; ++i) {
    carry_out(state, TurnLightBy{1.0, 0.0});
    lab.thread().post(1, {state.revision, state.setup});
  }
  const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  EXPECT_EQ(done->outcome->picture(Picture::labels).size, lab_size);
  EXPECT_EQ(done->outcome->light, posed_light(state));
}

// Left while it is drawn, and while it is compared; what comes afterwards is as if it had not been.
TEST(RenderThread, WhatTakesMinutesIsLeftForANewerOrder) {
  Lab lab("acne-floor", {}), fresh("acne-floor", {});
  ViewState state = fresh.state(*fresh.until(is_open));
  lab.until(is_open);
  raster::MapOptions slow = state.setup.map;
  slow.technique = raster::Technique::pcss, slow.size = 2048;
  slow.filter.samples = slow.filter.blocker_samples = 1024;
  for (const ImageSize size : {ImageSize{3840, 2160}, ImageSize{480, 270}}) {
    ViewState heavy = state;
    heavy.setup.size = size;
    carry_out(heavy, SetMap{slow});
    carry_out(heavy, LightSizeTo{1.0});  // without a size nothing is looked for around a point
    lab.thread().post(1, {heavy.revision, heavy.setup});
    if (size.width == 480) lab.until([&](const Snapshot& shown) { return shown.is_drawn(heavy); });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    state.revision = heavy.revision;
    carry_out(state, TurnLightBy{1.0, 0.0});
    lab.thread().post(1, {state.revision, state.setup});
    fresh.thread().post(1, {state.revision, state.setup});
    const auto is_done = [&](const Snapshot& shown) { return shown.is_done(state); };
    const auto after = lab.until(is_done), without = fresh.until(is_done);
    EXPECT_EQ(after->live.picture->data, without->live.picture->data);
    EXPECT_EQ(after->outcome->picture(Picture::labels).data, without->outcome->picture(Picture::labels).data);
    EXPECT_FALSE(after->undrawable || after->incomparable);
    EXPECT_EQ(lab.drawn().contains(heavy.revision), size.width == 480)
        << "the larger one was drawn to its end";
  }
}

// All are asked for while the thread has something else to do.
TEST(RenderThread, OrdersThatANewerOneFollowsAreNotDrawn) {
  std::promise<void> begin;
  Lab first("floating-box", {}), lab("floating-box", {}, begin.get_future().share());
  ViewState state = first.state(*first.until(is_open));
  for (int i = 0; i < 20; ++i) {
    carry_out(state, TurnLightBy{1.0, 0.0});
    lab.thread().post(1, {state.revision, state.setup});
  }
  begin.set_value();
  lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  EXPECT_EQ(lab.drawn(), (std::set<std::uint64_t>{0, state.revision}));
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
Image<compare::Label> compared_labels(const ViewState& state, const app::LoadedScene& loaded,
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

/// One thing, so that the worker may keep what does not depend on it.
void change_one_thing(ViewState& state, int which) {
  raster::MapOptions map = state.setup.map;
  switch (which) {
    case 0:
      set_bias_texels(map.bias, map.bias.constant + 0.5, 1.0);
      break;
    case 1:
      map.technique =
          map.technique == raster::Technique::hard ? raster::Technique::pcf : raster::Technique::hard;
      break;
    case 2:
      map.cull = map.cull == raster::Cull::none ? raster::Cull::front : raster::Cull::none;
      break;
    case 3:
      map.size = map.size == 64 ? 100 : 64;
      break;
    case 4:
      return carry_out(state, TurnLightBy{15.0, 0.0});
    case 5:
      map.technique =
          map.technique == raster::Technique::csm ? raster::Technique::hard : raster::Technique::csm;
      break;
    case 6:
      return carry_out(state, OrbitTo{double(state.revision % 90), 30.0});
    default:
      return carry_out(state, LightSizeTo{state.revision % 2 == 0 ? 4.0 : 0.0});
  }
  carry_out(state, SetMap{map});
}

/// Changes a state twenty times, and expects each time of the lab what `gnomon compare` makes of it.
void expect_labels_of_compare(const std::function<void(ViewState&, int)>& change) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  const auto source = read_source({"floating-box", false}, {}, {});
  ASSERT_TRUE(source);
  app::Console quiet(true);
  auto renderer = app::make_renderer(raster::Backend::automatic, *source->loaded, quiet);
  ASSERT_TRUE(renderer);
  for (int i = 0; i < 20; ++i) {
    change(state, i);
    lab.thread().post(1, {state.revision, state.setup});
    const auto done = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
    EXPECT_EQ(done->outcome->comparison.lights.front().labels.data,
              compared_labels(state, *source->loaded, **renderer).data)
        << i;
  }
}

TEST(RenderThread, LabelsAreThoseOfCompareInTwentyRandomStates) {
  std::mt19937 random(11);
  expect_labels_of_compare([&](ViewState& state, int) { change_at_random(state, random); });
}

TEST(RenderThread, LabelsAreThoseOfCompareWhereOneThingChanges) {
  std::mt19937 random(12);
  expect_labels_of_compare(
      [&](ViewState& state, int i) { change_one_thing(state, i < 8 ? i : static_cast<int>(random() % 8)); });
}

// A light that gets a size calls for soft shadows, which the scene itself has none of.
// A bias and a map's size leave the rays as they are.
TEST(RenderThread, WhileTheRaysAreKnownNothingIsComparedSmaller) {
  Lab lab("floating-box", {});
  ViewState state = lab.state(*lab.until(is_open));
  const auto is_seen_smaller = [&] {
    bool seen = false;
    lab.thread().post(1, {state.revision, state.setup});
    lab.until([&](const Snapshot& shown) {
      seen = seen || (shown.outcome && shown.outcome->revision == state.revision && shown.outcome->preview);
      return shown.is_done(state);
    });
    return seen;
  };
  is_seen_smaller();  // the first comparison traces them
  for (const int which : {0, 3, 0}) {
    change_one_thing(state, which);
    EXPECT_FALSE(is_seen_smaller()) << which;
  }
}

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
  app::Console quiet(true);
  auto renderer = app::make_renderer(raster::Backend::automatic, *source->loaded, quiet);
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
  write_whole(path, scene_with_radius("0.5"));
  Lab lab(path, {});
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto small = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  write_whole(path, scene_with_radius("1.25"));
  const auto again = lab.until([](const Snapshot& shown) { return shown.scene->number == 2; });
  EXPECT_TRUE(again->scene->again);
  EXPECT_NE(again->live.picture->data, small->live.picture->data);
  write_whole(path, "{ this is no scene");
  const auto broken = lab.until([](const Snapshot& shown) { return shown.unreadable.has_value(); });
  EXPECT_NE(broken->unreadable->file.find("plain.json"), std::string::npos);
  EXPECT_EQ(broken->scene->number, 2u);  // its exposure may be that of a comparison that has ended since
  EXPECT_NE(broken->live.picture->data, small->live.picture->data);
  write_whole(path, scene_with_radius("0.75"));
  const auto mended = lab.until([](const Snapshot& shown) { return shown.scene->number == 3; });
  EXPECT_FALSE(mended->unreadable);
}

TEST(RenderThread, AShaderThatDoesNotCompileLeavesTheLastGoodPicture) {
  const app_test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "technique");
  const std::string path = folder / "technique/hard.glsl", own = own_shader("technique/hard.glsl");
  write_whole(path, own + "// mine\n");
  Lab lab("floating-box", folder.path());
  ViewState state = lab.state(*lab.until(is_open));
  lab.thread().post(1, {state.revision, state.setup});
  const auto good = lab.until([&](const Snapshot& shown) { return shown.is_done(state); });
  write_whole(path, own + "float mistake = ;\n");
  const auto broken = lab.until([](const Snapshot& shown) { return shown.unreadable.has_value(); });
  EXPECT_NE(broken->unreadable->message().find("hard.glsl"), std::string::npos)
      << broken->unreadable->message();
  EXPECT_EQ(broken->live.picture->data, good->live.picture->data);
  write_whole(path, own + "// mine once more\n");
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

}  // namespace
}  // namespace gnomon::lab
