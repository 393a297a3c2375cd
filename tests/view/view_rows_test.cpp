// The lab's presets and bias in texels, and the window's arithmetic.
#include "lab/view/state/presets.h"

#include <gtest/gtest.h>

#include "lab/view/state/projection.h"
#include "lab/view/window/layout.h"
#include "raster/technique_traits.h"
#include "tests/view/view_fixture.h"

namespace gnomon::lab {
namespace {

TEST(ViewPresets, BiasInTexelsKeepsItsUnit) {
  raster::Bias bias{.constant = 0.3, .unit = raster::BiasUnit::world};
  EXPECT_DOUBLE_EQ(bias_texels(bias, 0.3, 0.1), 3.0);
  set_bias_texels(bias, 2.0, 0.1);
  EXPECT_EQ(bias.unit, raster::BiasUnit::world);
  EXPECT_DOUBLE_EQ(bias.constant, 0.2);
  bias = {.constant = 1.0, .unit = raster::BiasUnit::automatic};
  set_bias_texels(bias, 2.0, 0.1);
  EXPECT_EQ(bias.unit, raster::BiasUnit::texel);
  EXPECT_EQ(bias.constant, 2.0);
}

TEST(ViewPresets, PresetsCanBeDrawn) {
  for (const Preset& preset : presets())
    for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
      raster::MapOptions map;
      map.technique = traits.technique;
      map.bias.receiver_plane = !raster::uses_moments(traits.technique);
      EXPECT_TRUE(raster::check_map_options(preset.apply(map))) << preset.title << " from " << traits.name;
    }
}

TEST(ViewPresets, WhatAPresetShowsIsNotWhatAnotherLeft) {
  for (const Preset& before : presets())
    for (const Preset& preset : presets()) {
      const raster::MapOptions alone = preset.apply({}), after = preset.apply(before.apply({}));
      EXPECT_EQ(after.size, alone.size) << preset.title << " after " << before.title;
      EXPECT_EQ(after.bias, alone.bias) << preset.title << " after " << before.title;
    }
}

TEST(ViewLayout, WithoutPanelsThePictureIsTheWindow) {
  Look look;
  look.panels = false;
  EXPECT_EQ(lay_out({480, 270}, look, type_size(1.0)).picture, (ImageSize{480, 270}));
}

TEST(ViewLayout, NothingOverlapsAndAllIsFilled) {
  for (const int width : {800, 1280, 2560})
    for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
      Look look;
      const LabLayout layout = lay_out({width, 720}, look, type_size(scale));
      EXPECT_EQ(layout.settings.width + layout.pictures.width + layout.results.width, width);
      EXPECT_EQ(layout.menu.height + layout.pictures.height + layout.status.height, 720);
      EXPECT_GE(layout.pictures.width, 0.3 * width) << width << " at " << scale;
      EXPECT_EQ(layout.tabs, layout.results.width == 0);
    }
}

TEST(ViewLayout, FourPanesAreAlike) {
  Look look;
  look.layout = PaneLayout::quad;
  const LabLayout layout = lay_out({1281, 721}, look, type_size(1.0));
  ASSERT_EQ(layout.panes.size(), 4u);
  for (const Box& pane : layout.panes) {
    EXPECT_EQ(pane.width, layout.picture.width);
    EXPECT_EQ(pane.height, layout.picture.height);
  }
}

TEST(ViewLayout, TheViewsOfASwipeShareAPane) {
  Look look;
  const LabLayout layout = lay_out({1280, 720}, look, type_size(1.0));
  const auto views = [&] { return shown_views(layout, look, Picture::difference, Picture::raster); };
  ASSERT_EQ(views().size(), 1u);
  EXPECT_EQ(views()[0].picture, Picture::difference);
  look.layout = PaneLayout::swipe;
  look.swipe = 0.25;
  ASSERT_EQ(views().size(), 2u);
  const ShownView left = views()[0], right = views()[1];
  EXPECT_EQ(left.picture, Picture::raster);
  EXPECT_EQ(right.picture, Picture::difference);
  EXPECT_EQ(left.pane, layout.panes.front());
  EXPECT_EQ(right.pane, layout.panes.front());
  EXPECT_EQ(left.part.x + left.part.width, right.part.x);
  EXPECT_EQ(left.part.width + right.part.width, layout.panes.front().width);
  EXPECT_NEAR(left.part.width, 0.25 * layout.panes.front().width, 0.5);
}

TEST(ViewProjection, WhatIsProjectedComesBack) {
  for (const bool parallel : {false, true}) {
    ViewState state = two_light_state();
    if (parallel) carry_out(state, HeightTo{3.0});
    const ScreenCamera camera{posed_camera(state), {100, 20, 640, 480}};
    const Vec3 place{0.4, 0.3, -0.2};
    const auto pixel = camera.project(place);
    ASSERT_TRUE(pixel);
    const Ray ray = camera.ray(*pixel);
    const Vec3 to = place - ray.origin;
    EXPECT_LT(glm::length(glm::normalize(ray.direction) - glm::normalize(to)), 1e-12);
    EXPECT_FALSE(camera.project(camera.camera.eye - to));
  }
}

TEST(ViewProjection, TheHandleFollowsThePointer) {
  for (const bool parallel : {false, true})
    for (const bool lamp : {false, true}) {
      ViewState state = two_light_state();
      if (lamp) carry_out(state, NextLight{});
      if (parallel) carry_out(state, HeightTo{4.0});
      carry_out(state, LightElevationTo{50.0});
      const ScreenCamera camera{posed_camera(state), {0, 0, 640, 480}};
      const auto from = camera.project(light_handle(state).place);
      ASSERT_TRUE(from);
      const Vec2 wanted = *from + Vec2{9.0, 6.0};
      carry_out(state, drag_handle(state, light_handle(state), camera, wanted));
      const auto now = camera.project(light_handle(state).place);
      ASSERT_TRUE(now);
      EXPECT_LT(glm::length(*now - wanted), 0.01)
          << (lamp ? "lamp" : "sun");  // pixels; poses keep nine digits
    }
}

}  // namespace
}  // namespace gnomon::lab
