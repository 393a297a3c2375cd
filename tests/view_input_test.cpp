// Keys, wheel and drags as actions.
#include "app/view/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "tests/view_fixture.h"

namespace gnomon::app {
namespace {

/// The change that a key makes; fails the test when it makes none of that kind.
template <class Kind>
Kind change_of_key(int key, bool shift = false) {
  const auto action = action_for_key(key, shift);
  const Change* change = action ? std::get_if<Change>(&*action) : nullptr;
  const Kind* kind = change == nullptr ? nullptr : std::get_if<Kind>(change);
  EXPECT_NE(kind, nullptr) << "key " << key;
  return kind == nullptr ? Kind{} : *kind;
}

Command command_of_key(int key) {
  const auto action = action_for_key(key, false);
  EXPECT_TRUE(action && std::holds_alternative<Command>(*action)) << "key " << key;
  return std::get<Command>(*action);
}

TEST(ViewInput, DigitsChooseTheView) {
  EXPECT_EQ(change_of_key<Show>(GLFW_KEY_1).picture, Picture::raster);
  EXPECT_EQ(change_of_key<Show>(GLFW_KEY_2).picture, Picture::raytrace);
  EXPECT_EQ(change_of_key<Show>(GLFW_KEY_3).picture, Picture::difference);
  EXPECT_EQ(change_of_key<Show>(GLFW_KEY_4).picture, Picture::labels);
  EXPECT_EQ(change_of_key<Show>(GLFW_KEY_5).picture, Picture::depth);
  change_of_key<ShowPrevious>(GLFW_KEY_TAB);
}

TEST(ViewInput, OppositeKeysUndoEachOther) {
  const auto sum = [](OrbitBy a, OrbitBy b) {
    return std::abs(a.azimuth + b.azimuth) + std::abs(a.elevation + b.elevation);
  };
  EXPECT_EQ(sum(change_of_key<OrbitBy>(GLFW_KEY_LEFT), change_of_key<OrbitBy>(GLFW_KEY_RIGHT)), 0.0);
  EXPECT_EQ(sum(change_of_key<OrbitBy>(GLFW_KEY_UP), change_of_key<OrbitBy>(GLFW_KEY_DOWN)), 0.0);
  EXPECT_GT(change_of_key<TurnLightBy>(GLFW_KEY_RIGHT_BRACKET).azimuth, 0.0);
  EXPECT_LT(change_of_key<TurnLightBy>(GLFW_KEY_LEFT_BRACKET).azimuth, 0.0);
  EXPECT_GT(change_of_key<TurnLightBy>(GLFW_KEY_APOSTROPHE).elevation, 0.0);
  EXPECT_LT(change_of_key<TurnLightBy>(GLFW_KEY_SEMICOLON).elevation, 0.0);
  EXPECT_GT(change_of_key<StepBias>(GLFW_KEY_EQUAL).texels, 0.0);
  EXPECT_LT(change_of_key<StepBias>(GLFW_KEY_MINUS).texels, 0.0);
  EXPECT_GT(change_of_key<StepSlopeBias>(GLFW_KEY_0).amount, 0.0);
  EXPECT_LT(change_of_key<StepSlopeBias>(GLFW_KEY_9).amount, 0.0);
  EXPECT_GT(change_of_key<StepNormalOffset>(GLFW_KEY_8).texels, 0.0);
  EXPECT_LT(change_of_key<StepNormalOffset>(GLFW_KEY_7).texels, 0.0);
  change_of_key<DoubleMap>(GLFW_KEY_PERIOD);
  change_of_key<HalveMap>(GLFW_KEY_COMMA);
}

TEST(ViewInput, ShiftMakesBiasCoarserAndTurningFiner) {
  EXPECT_GT(change_of_key<StepBias>(GLFW_KEY_EQUAL, true).texels,
            change_of_key<StepBias>(GLFW_KEY_EQUAL).texels);
  EXPECT_LT(change_of_key<OrbitBy>(GLFW_KEY_RIGHT, true).azimuth,
            change_of_key<OrbitBy>(GLFW_KEY_RIGHT).azimuth);
}

TEST(ViewInput, Commands) {
  EXPECT_EQ(command_of_key(GLFW_KEY_P), Command::save_screenshot);
  EXPECT_EQ(command_of_key(GLFW_KEY_F12), Command::save_screenshot);
  EXPECT_EQ(command_of_key(GLFW_KEY_C), Command::print_command);
  EXPECT_EQ(command_of_key(GLFW_KEY_H), Command::print_help);
  EXPECT_EQ(command_of_key(GLFW_KEY_F1), Command::print_help);
  EXPECT_EQ(command_of_key(GLFW_KEY_Q), Command::quit);
  EXPECT_EQ(command_of_key(GLFW_KEY_ESCAPE), Command::quit);
  EXPECT_FALSE(action_for_key(GLFW_KEY_X, false));
}

TEST(ViewInput, WheelUpComesNearer) {
  ViewState state = two_light_state();
  carry_out(state, zoom_for_scroll(2.0));
  EXPECT_LT(state.setup.camera->distance, 5.0);
  carry_out(state, zoom_for_scroll(-2.0));
  EXPECT_NEAR(state.setup.camera->distance, 5.0, 1e-7);  // steps keep nine digits
}

TEST(ViewInput, DragsTurnOnlyWhileAButtonIsDown) {
  Pointer pointer;
  EXPECT_FALSE(pointer.move_to(100.0, 100.0));
  pointer.press(GLFW_MOUSE_BUTTON_LEFT);
  const auto orbit = pointer.move_to(110.0, 104.0);
  ASSERT_TRUE(orbit && std::holds_alternative<OrbitBy>(*orbit));
  EXPECT_LT(std::get<OrbitBy>(*orbit).azimuth, 0.0);  // the eye goes left, so the scene follows the hand
  EXPECT_GT(std::get<OrbitBy>(*orbit).elevation, 0.0);
  pointer.release(GLFW_MOUSE_BUTTON_LEFT);
  EXPECT_FALSE(pointer.move_to(0.0, 0.0));
  pointer.press(GLFW_MOUSE_BUTTON_RIGHT);
  const auto turn = pointer.move_to(8.0, 0.0);
  ASSERT_TRUE(turn && std::holds_alternative<TurnLightBy>(*turn));
}

}  // namespace
}  // namespace gnomon::app
