// The settings panel's rows against the command line's own table, and the window's arithmetic.
#include "app/view/map_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/technique_options.h"
#include "app/view/layout.h"
#include "app/view/map_option.h"
#include "app/view/projection.h"
#include "raster/technique_traits.h"
#include "tests/view_fixture.h"

namespace gnomon::app {
namespace {

TEST(ViewRows, EveryOptionThatATechniqueReadsHasOneRow) {
  for (const std::string_view option : technique_options()) {
    const auto rows = map_rows();
    EXPECT_EQ(
        std::count_if(rows.begin(), rows.end(), [&](const MapRow& row) { return row.option == option; }), 1)
        << option;
  }
}

TEST(ViewRows, WhatIsShownIsWhatTheTechniqueReads) {
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    raster::MapOptions map;
    map.technique = traits.technique;
    for (const MapRow& row : map_rows())
      EXPECT_EQ(is_read(row, map), technique_reads(row.option, map)) << row.option;
  }
}

TEST(ViewRows, EveryRowSaysWhatItDoesToBothArtifacts) {
  for (const MapRow& row : map_rows()) {
    EXPECT_FALSE(row.what.empty()) << row.option;
    EXPECT_FALSE(row.acne.empty()) << row.option;
    EXPECT_FALSE(row.peter_panning.empty()) << row.option;
  }
}

TEST(ViewRows, NumbersAreSetWhereTheyAreRead) {
  for (const MapRow& row : map_rows()) {
    raster::MapOptions map;
    if (const auto* number = std::get_if<NumberRow>(&row.kind)) {
      const double value = 0.5 * (number->from + number->to);
      number->set(map, value);
      EXPECT_EQ(number->get(map), value) << row.option;
    }
    if (const auto* integer = std::get_if<IntegerRow>(&row.kind)) {
      integer->set(map, integer->to);
      EXPECT_EQ(integer->get(map), integer->to) << row.option;
    }
    EXPECT_TRUE(raster::check_map_options(map)) << row.option;
  }
}

TEST(ViewRows, ChoicesAreTheCommandLines) {
  for (const MapRow& row : map_rows()) {
    const auto* choice = std::get_if<ChoiceRow>(&row.kind);
    if (choice == nullptr) continue;
    const std::vector<std::string_view> names = choice->names();
    EXPECT_GE(names.size(), 3u) << row.option;
    for (std::size_t i = 0; i < names.size(); ++i) {
      raster::MapOptions map, panel;
      ASSERT_TRUE(set_map_option(map, std::string(row.option), std::string(names[i]))) << names[i];
      EXPECT_EQ(choice->get(map), i) << names[i];
      choice->set(panel, i);
      EXPECT_EQ(choice->get(panel), i) << names[i];
    }
  }
}

TEST(ViewRows, BiasInTexelsKeepsItsUnit) {
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

TEST(ViewRows, PresetsCanBeDrawn) {
  for (const Preset& preset : presets())
    for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
      raster::MapOptions map;
      map.technique = traits.technique;
      map.bias.receiver_plane = !raster::uses_moments(traits.technique);
      EXPECT_TRUE(raster::check_map_options(preset.apply(map))) << preset.title << " from " << traits.name;
    }
}

TEST(ViewRows, WhatAPresetShowsIsNotWhatAnotherLeft) {
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
  const ViewState state = two_light_state();
  const ScreenCamera camera{posed_camera(state), {100, 20, 640, 480}};
  const Vec3 place{0.4, 0.3, -0.2};
  const auto pixel = camera.project(place);
  ASSERT_TRUE(pixel);
  const Vec3 way = camera.direction(*pixel), to = place - camera.camera.eye;
  EXPECT_LT(glm::length(glm::normalize(way) - glm::normalize(to)), 1e-12);
  EXPECT_FALSE(camera.project(camera.camera.eye - to));
}

TEST(ViewProjection, TheHandleFollowsThePointer) {
  for (const bool lamp : {false, true}) {
    ViewState state = two_light_state();
    if (lamp) carry_out(state, NextLight{});
    carry_out(state, LightElevationTo{50.0});
    const ScreenCamera camera{posed_camera(state), {0, 0, 640, 480}};
    const auto from = camera.project(light_handle(state).place);
    ASSERT_TRUE(from);
    const Vec2 wanted = *from + Vec2{9.0, 6.0};
    carry_out(state, drag_handle(state, light_handle(state), camera, wanted));
    const auto now = camera.project(light_handle(state).place);
    ASSERT_TRUE(now);
    EXPECT_LT(glm::length(*now - wanted), 0.01) << (lamp ? "lamp" : "sun");  // pixels; poses keep nine digits
  }
}

}  // namespace
}  // namespace gnomon::app
