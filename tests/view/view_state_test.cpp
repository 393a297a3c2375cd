// What each action does to the state; no display is needed for any of it.
#include "lab/view/state/state.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lab/view/work/worker.h"
#include "tests/view/view_fixture.h"

namespace gnomon::lab {
namespace {

ViewState after(ViewState state, std::initializer_list<Change> changes) {
  for (const Change& change : changes) carry_out(state, change);
  return state;
}

TEST(ViewState, TabFlipsBetweenTheLastTwoViews) {
  ViewState state =
      after(two_light_state(), {Show{Picture::labels}, Show{Picture::difference}, ShowPrevious{}});
  EXPECT_EQ(state.picture, Picture::labels);
  carry_out(state, ShowPrevious{});
  EXPECT_EQ(state.picture, Picture::difference);
  carry_out(state, Show{Picture::difference});  // the same again is no move
  carry_out(state, ShowPrevious{});
  EXPECT_EQ(state.picture, Picture::labels);
}

TEST(ViewState, ChoosingAViewAsksForNoNewPictures) {
  const ViewState state = two_light_state();
  EXPECT_EQ(after(state, {Show{Picture::labels}, ShowPrevious{}}).revision, state.revision);
  EXPECT_GT(after(state, {OrbitBy{1.0, 0.0}}).revision, state.revision);
  EXPECT_GT(after(state, {StepBias{1.0}}).revision, state.revision);
  EXPECT_GT(after(state, {NextLight{}}).revision, state.revision);
}

TEST(ViewState, UntouchedCameraAndLightsAreTheFilesToTheLastBit) {
  const ViewState state = after(two_light_state(), {StepBias{1.0}, DoubleMap{}});
  Scene scene;
  place(state.given, state.setup, scene);
  EXPECT_EQ(scene.camera.eye, state.given.camera.eye);
  EXPECT_EQ(scene.lights[0].direction, state.given.lights[0].direction);
  EXPECT_EQ(scene.lights[1].position, state.given.lights[1].position);
}

TEST(ViewState, OrbitKeepsTheDistanceAndStopsBeforeThePole) {
  const ViewState state = after(two_light_state(), {OrbitBy{30.0, 500.0}});
  ASSERT_TRUE(state.setup.camera);
  EXPECT_NEAR(state.setup.camera->azimuth_degrees, 30.0, 1e-12);
  EXPECT_EQ(state.setup.camera->elevation_degrees, app::max_camera_elevation_degrees);
  EXPECT_EQ(state.setup.camera->distance, 5.0);
}

TEST(ViewState, ZoomIsBoundedByTheFilesOwnDistance) {
  EXPECT_NEAR(after(two_light_state(), {ZoomBy{0.5}}).setup.camera->distance, 2.5, 1e-12);
  EXPECT_EQ(after(two_light_state(), {ZoomBy{1e9}}).setup.camera->distance, 5.0 * max_zoom);
  EXPECT_EQ(after(two_light_state(), {ZoomBy{0.0}}).setup.camera->distance, 5.0 / max_zoom);
  EXPECT_EQ(after(two_light_state(), {DistanceTo{12.0}}).setup.camera->distance, 12.0);
}

TEST(ViewState, ZoomChangesAnOrthographicPicturesHeight) {
  ViewState state = two_light_state();
  state.given.camera.orthographic_height = 3.0;
  const ViewState nearer = after(state, {ZoomBy{0.5}});
  EXPECT_NEAR(posed_camera(nearer).orthographic_height, 1.5, 1e-12);
  EXPECT_EQ(nearer.setup.camera->distance, 5.0);
  EXPECT_EQ(posed_camera(after(state, {ZoomBy{1e9}})).orthographic_height, 3.0 * max_zoom);
  EXPECT_EQ(posed_camera(after(state, {OrbitBy{30.0, 5.0}})).orthographic_height, 3.0);
  // A pinhole camera becomes one where its height is said.
  EXPECT_EQ(posed_camera(after(two_light_state(), {HeightTo{2.0}})).orthographic_height, 2.0);
}

TEST(ViewState, OnlyTheChosenLightTurns) {
  const ViewState state = after(two_light_state(), {NextLight{}, TurnLightBy{90.0, 30.0}});
  EXPECT_FALSE(state.setup.lights[0]);
  ASSERT_TRUE(state.setup.lights[1]);
  EXPECT_EQ(state.light_name(), "lamp");
  Scene scene;
  place(state.given, state.setup, scene);
  EXPECT_NEAR(scene.lights[1].position.y, 1.0, 1e-12);  // two away, thirty degrees up
  EXPECT_NEAR(scene.lights[1].position.x, std::sqrt(3.0), 1e-12);
  EXPECT_EQ(after(state, {NextLight{}}).setup.light, 0u);
}

TEST(ViewState, LightAnglesAreSetOneByOne) {
  const ViewState state = after(two_light_state(), {LightElevationTo{40.0}, LightAzimuthTo{-10.0}});
  EXPECT_EQ(state.setup.lights[0], (app::LightPose{-10.0, 40.0}));
}

TEST(ViewState, BiasStepsAreTexelsInEitherUnit) {
  ViewState state = two_light_state();
  state.setup.map.bias = {1.0, raster::BiasUnit::texel};
  EXPECT_EQ(after(state, {StepBias{0.25}}).setup.map.bias.constant, 1.25);
  state.setup.map.bias = {0.02, raster::BiasUnit::world};
  EXPECT_DOUBLE_EQ(after(state, {StepBias{0.5}}).setup.map.bias.constant, 0.025);
}

TEST(ViewState, BiasStepsStopAtZeroOnce) {
  ViewState state = two_light_state();
  state.setup.map.bias = {0.5, raster::BiasUnit::texel};
  carry_out(state, StepBias{-1.0});
  EXPECT_EQ(state.setup.map.bias.constant, 0.0);
  carry_out(state, StepBias{-1.0});
  EXPECT_EQ(state.setup.map.bias.constant, -1.0);
  carry_out(state, StepBias{3.0});
  EXPECT_EQ(state.setup.map.bias.constant, 0.0);
  EXPECT_EQ(after(state, {StepNormalOffset{-1.0}}).setup.map.bias.normal_offset_texels, 0.0);
}

TEST(ViewState, StepsLeaveNumbersThatCanBeTyped) {
  ViewState state = two_light_state();
  state.given.lights[0] = app::posed_light(state.given.lights[0], Vec3(0.0), {-69.0, 18.5});
  carry_out(state, TurnLightBy{6.0, 0.0});
  EXPECT_EQ(state.setup.lights[0], (app::LightPose{-63.0, 18.5}));
  state.setup.map.bias = {0.1, raster::BiasUnit::world};
  state.texel_world = 0.2;
  carry_out(state, StepBias{1.0});
  EXPECT_EQ(state.setup.map.bias.constant, 0.3);  // not 0.30000000000000004
}

TEST(ViewState, MapSizeStaysWithinTheContext) {
  ViewState state = two_light_state();
  state.max_map_size = 3000;
  EXPECT_EQ(after(state, {DoubleMap{}}).setup.map.size, 2048);
  EXPECT_EQ(after(state, {DoubleMap{}, DoubleMap{}}).setup.map.size, 3000);
  for (int i = 0; i < 20; ++i) carry_out(state, HalveMap{});
  EXPECT_EQ(state.setup.map.size, 1);
}

TEST(ViewState, FormatsAndCullingGoRound) {
  const ViewState start = two_light_state();
  ViewState formats = start;
  for (const auto next : {raster::DepthFormat::d32f_reversed, raster::DepthFormat::d16,
                          raster::DepthFormat::d24, raster::DepthFormat::d32f}) {
    carry_out(formats, NextDepthFormat{});
    EXPECT_EQ(formats.setup.map.depth_format, next);
  }
  EXPECT_EQ(after(start, {NextCull{}}).setup.map.cull, raster::Cull::front);
  EXPECT_EQ(after(start, {NextCull{}, NextCull{}, NextCull{}}).setup.map.cull, raster::Cull::none);
}

TEST(ViewState, MapOptionsAreTheCommandLines) {
  const ViewState state =
      after(two_light_state(), {SetMapOption{"bias", "0.5texel"}, SetMapOption{"slope-bias", "-2"},
                                SetMapOption{"depth-format", "d16"}, SetMapOption{"receiver-plane", "on"}});
  EXPECT_EQ(state.setup.map.bias.constant, 0.5);
  EXPECT_EQ(state.setup.map.bias.unit, raster::BiasUnit::texel);
  EXPECT_EQ(state.setup.map.bias.slope, -2.0);
  EXPECT_TRUE(state.setup.map.bias.receiver_plane);
  EXPECT_EQ(state.setup.map.depth_format, raster::DepthFormat::d16);
  EXPECT_EQ(state.setup.map.size, raster::MapOptions{}.size);
}

TEST(ViewState, ResetKeepsTheWindowsSize) {
  const ViewState state =
      after(two_light_state(), {Resize{{300, 200}}, OrbitBy{5.0, 5.0}, StepBias{1.0}, TurnLightBy{1.0, 1.0},
                                NextLight{}, DoubleMap{}, Reset{}});
  EXPECT_FALSE(state.setup.camera);
  EXPECT_FALSE(state.setup.lights[0]);
  EXPECT_EQ(state.setup.light, 0u);
  EXPECT_EQ(state.setup.map.size, raster::MapOptions{}.size);
  EXPECT_EQ(state.setup.map.bias.constant, raster::Bias{}.constant);
  EXPECT_EQ(state.setup.size, (ImageSize{300, 200}));
}

TEST(ViewState, PanMovesTheTargetAcrossTheView) {
  const ViewState state = after(two_light_state(), {PanBy{0.5, 0.0}});
  ASSERT_TRUE(state.setup.camera && state.setup.camera->target);
  const Camera camera = posed_camera(state);
  EXPECT_GT(camera.target.x, 0.0);
  EXPECT_NEAR(camera.target.y, 0.0, 1e-9);
  EXPECT_NEAR(glm::length(camera.eye - camera.target), 5.0, 1e-7);  // steps keep nine digits
}

TEST(ViewState, ALampGoesWhereItIsPlaced) {
  const Vec3 wanted{1.0, 2.0, -1.5};
  const ViewState state = after(two_light_state(), {NextLight{}, PlaceLamp{wanted}});
  EXPECT_LT(glm::length(posed_light(state).position - wanted), 1e-7);
  EXPECT_EQ(after(two_light_state(), {PlaceLamp{wanted}}).setup.lights[0],
            std::nullopt);  // a sun has no place
}

TEST(ViewState, TheSunStandsInTheSouthAtNoonAndComesFromTheEast) {
  const app::LightPose noon = sun_at(12.0), morning = sun_at(8.0), evening = sun_at(18.0);
  EXPECT_NEAR(noon.azimuth_degrees, 0.0, 1e-9);
  EXPECT_NEAR(noon.elevation_degrees, 45.0, 1e-9);
  EXPECT_GT(morning.azimuth_degrees, 0.0);
  EXPECT_NEAR(evening.azimuth_degrees, -90.0, 1e-9);
  EXPECT_NEAR(evening.elevation_degrees, 0.0, 1e-9);
  for (const double hours : {6.5, 9.0, 15.25}) EXPECT_NEAR(sun_hour(sun_at(hours)), hours, 1e-9);
}

TEST(ViewState, ThePlaceUnderThePointerStaysWhenPicturesGrow) {
  ViewState state = after(two_light_state(), {ZoomPicture{2.0, {0.25, 0.5}}});
  const auto on_screen = [&](double share) { return 0.5 + state.look.zoom * (share - state.look.middle.x); };
  EXPECT_NEAR(on_screen(0.25), 0.25, 1e-12);
  carry_out(state, ZoomPicture{2.0, {0.25, 0.5}});
  EXPECT_NEAR(on_screen(0.25), 0.25, 1e-12);
  carry_out(state, ZoomPictureTo{1.0});
  EXPECT_EQ(state.look.middle, Vec2(0.5, 0.5));
}

TEST(ViewState, TheLookAsksForNoNewPictures) {
  const ViewState state = two_light_state();
  EXPECT_EQ(after(state, {SetLayout{PaneLayout::quad}, NextTheme{}, ScaleUi{1.25}, ToggleFlag{&Look::help},
                          ProbePixel{PixelPlace{3, 4}}, SwipeTo{0.2}, SetPane{1, Picture::gap}})
                .revision,
            state.revision);
}

TEST(ViewState, TheProbedPixelKeepsItsPlaceInThePicture) {
  const ViewState state =
      after(two_light_state(), {Resize{{100, 50}}, ProbePixel{PixelPlace{50, 25}}, Resize{{200, 100}}});
  EXPECT_EQ(state.look.probe, (PixelPlace{101, 51}));
}

TEST(ViewState, PictureNamesReadBack) {
  for (const char* name : {"raster", "raytrace", "difference", "labels", "truth", "gap", "texels", "depth"}) {
    const auto picture = parse_picture(name);
    ASSERT_TRUE(picture) << name;
    EXPECT_EQ(picture_name(*picture), name);
  }
  EXPECT_NE(parse_picture("label").error().reason.find("did you mean labels?"), std::string::npos);
}

TEST(ViewState, EveryViewThatIsNoPhotographSaysWhatItsColoursStandFor) {
  for (std::size_t i = 0; i < picture_count; ++i) {
    const auto picture = static_cast<Picture>(i);
    const bool photograph = picture == Picture::raster || picture == Picture::raytrace;
    EXPECT_EQ(picture_legend(picture).empty(), photograph) << picture_name(picture);
  }
  const std::string scale = fmt::format("full colour at {} texels", gap_scale_texels);
  EXPECT_NE(picture_legend(Picture::gap).find(scale), std::string_view::npos) << scale;
}

}  // namespace
}  // namespace gnomon::lab
