// Films of the lab: where the camera and the lights stand at a moment, and how a state goes through them. Poses are held
// against the closed forms of the paths.
#include "lab/view/state/film.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/view/view_fixture.h"

namespace gnomon::lab {
namespace {

constexpr double rounding = 1e-8;  // a state's numbers have nine digits

std::vector<LabFilm> films(const ViewState& state, const std::vector<KeyedPath>& own = {}) {
  return films_of({state.given.camera, state.given.lights}, state.given.centre, own);
}

bool has(const std::vector<LabFilm>& all, std::string_view name) {
  return std::any_of(all.begin(), all.end(), [&](const LabFilm& film) { return film.name == name; });
}

/// The state with this film begun.
ViewState filmed(std::string_view name, const std::vector<KeyedPath>& own = {}) {
  ViewState state = two_light_state();
  state.given.films = films(state, own);
  for (std::size_t i = 0; i < state.given.films.size(); ++i)
    if (state.given.films[i].name == name) carry_out(state, PickFilm{i});
  EXPECT_TRUE(state.film.film) << name;
  return state;
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(glm::length(a - b), 10.0 * rounding) << a.x << " " << a.y << " " << a.z;
}

TEST(ViewFilm, AnOrbitIsTenDegreesASecond) {
  ViewState state = filmed("camera-orbit");
  carry_out(state, FilmTo{9.0});
  expect_near(posed_camera(state).eye, {4.0, 3.0, 0.0});  // from (0, 3, 4), a quarter about y
  expect_near(posed_camera(state).target, Vec3(0.0));
  EXPECT_EQ(posed_light(state), state.given.lights[0]);
}

TEST(ViewFilm, AWalkGoesAheadAndLevel) {
  ViewState state = filmed("camera-walk");
  carry_out(state, FilmTo{8.0});
  expect_near(posed_camera(state).eye, {0.0, 3.0, 0.0});  // eight tenths of the five to the target
  expect_near(posed_camera(state).target, {0.0, 0.0, -4.0});
}

TEST(ViewFilm, TheSunsDayHasTheScenesLightAtNoon) {
  ViewState state = filmed("sun");
  carry_out(state, FilmTo{10.0});
  expect_near(posed_light(state).direction, {0.0, -1.0, 0.0});
  carry_out(state, FilmTo{0.0});
  EXPECT_NEAR(current_light(state).elevation_degrees, 5.0, 1e-6);
  EXPECT_EQ(state.setup.camera, std::nullopt);
  EXPECT_EQ(state.setup.lights[1], std::nullopt);  // a lamp has no day
}

TEST(ViewFilm, KeysMoveALampAndItKeepsTheSizeThatWasSet) {
  KeyedPath path;
  path.name = "lamp-rises";
  path.lights["lamp"].position = KeyedVector{{Interpolation::linear, {0.0, 2.0}, {{0, 0, 2}, {0, 4, 2}}}};
  ViewState state = filmed("lamp-rises", {path});
  EXPECT_EQ(state.given.films.front().name, "lamp-rises");  // the scene's own come first
  carry_out(state, PickLight{1});
  carry_out(state, LightSizeTo{0.25});
  carry_out(state, FilmTo{1.0});
  expect_near(posed_light(state).position, {0.0, 2.0, 2.0});
  EXPECT_EQ(light_size(posed_light(state)), 0.25);
}

TEST(ViewFilm, APathThatAimsASpotAnewIsLeftOut) {
  ViewState state = two_light_state();
  Light& spot = state.given.lights[1];
  spot.type = LightType::spot;
  spot.direction = {0.0, 0.0, -1.0};
  KeyedPath path;
  path.name = "aims";
  path.lights["lamp"].direction = KeyedVector{{Interpolation::linear, {0.0, 1.0}, {{0, 0, -1}, {1, 0, -1}}}};
  EXPECT_FALSE(has(films(state, {path}), "aims"));
  EXPECT_TRUE(has(films(state), "light-orbit"));
}

TEST(ViewFilm, ItGoesOnToItsEndAndBeginsAgain) {
  ViewState state = filmed("sun");
  carry_out(state, PlayFilm{true});
  const std::uint64_t before = state.revision;
  carry_out(state, FilmGoesOn{15.0});
  EXPECT_EQ(state.film.seconds, 15.0);
  EXPECT_EQ(state.revision, before + 1);
  carry_out(state, FilmGoesOn{7.5});
  EXPECT_EQ(state.film.seconds, 2.5);  // of 20
  carry_out(state, TogglePlay{});
  EXPECT_FALSE(state.film.plays);
  carry_out(state, Reset{});
  EXPECT_FALSE(state.film.film);
}

TEST(ViewFilm, WithoutOnePickedThePlayKeyBeginsTheFirst) {
  ViewState state = two_light_state();
  carry_out(state, TogglePlay{});
  EXPECT_FALSE(state.film.plays);  // there is none
  state.given.films = films(state);
  carry_out(state, TogglePlay{});
  EXPECT_TRUE(state.film.plays);
  EXPECT_EQ(state.film.film, 0u);
}

}  // namespace
}  // namespace gnomon::lab
