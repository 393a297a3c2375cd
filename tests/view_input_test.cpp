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
  const auto action = action_for_key({key, {shift, false}});
  const Change* change = action ? std::get_if<Change>(&*action) : nullptr;
  const Kind* kind = change == nullptr ? nullptr : std::get_if<Kind>(change);
  EXPECT_NE(kind, nullptr) << "key " << key;
  return kind == nullptr ? Kind{} : *kind;
}

Command command_of_key(int key) {
  const auto action = action_for_key({key, {}});
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
  EXPECT_EQ(command_of_key(GLFW_KEY_C), Command::copy_command);
  EXPECT_EQ(command_of_key(GLFW_KEY_Q), Command::quit);
  EXPECT_EQ(command_of_key(GLFW_KEY_ESCAPE), Command::leave);
  EXPECT_EQ(change_of_key<ToggleFlag>(GLFW_KEY_F1).flag, &Look::help);
  EXPECT_EQ(change_of_key<ToggleFlag>(GLFW_KEY_F11).flag, &Look::panels);
  EXPECT_FALSE(action_for_key({GLFW_KEY_N, {}}));
}

TEST(ViewInput, ControlMakesOtherActionsOfTheSameKeys) {
  const auto action = action_for_key({GLFW_KEY_S, {false, true}});
  ASSERT_TRUE(action && std::holds_alternative<Command>(*action));
  EXPECT_EQ(std::get<Command>(*action), Command::save_scene);
  EXPECT_FALSE(action_for_key({GLFW_KEY_1, {false, true}}));
}

TEST(ViewInput, KeysHaveNames) {
  EXPECT_EQ(key_of_name("B")->code, GLFW_KEY_B);
  EXPECT_EQ(key_of_name("=")->code, GLFW_KEY_EQUAL);
  EXPECT_EQ(key_of_name("F9")->code, GLFW_KEY_F9);
  EXPECT_EQ(key_of_name("F11")->code, GLFW_KEY_F11);
  EXPECT_TRUE(key_of_name("ctrl+S")->held.control);
  EXPECT_TRUE(key_of_name("shift+tab")->held.shift);
  EXPECT_FALSE(key_of_name("enter"));
  EXPECT_FALSE(key_of_name("ctrl+"));
}

TEST(ViewInput, EveryKeyOfTheHelpDoesSomething) {
  for (const KeyGroup& group : key_groups()) EXPECT_FALSE(group.keys.empty()) << group.title;
  for (const int key :
       {GLFW_KEY_F2, GLFW_KEY_F3, GLFW_KEY_F4, GLFW_KEY_F5, GLFW_KEY_F6, GLFW_KEY_F7, GLFW_KEY_F8,
        GLFW_KEY_F9, GLFW_KEY_V, GLFW_KEY_Z, GLFW_KEY_X, GLFW_KEY_G, GLFW_KEY_T, GLFW_KEY_6})
    EXPECT_TRUE(action_for_key({key, {}})) << key;
  for (const int key : {GLFW_KEY_P, GLFW_KEY_R, GLFW_KEY_B, GLFW_KEY_EQUAL, GLFW_KEY_MINUS, GLFW_KEY_0})
    EXPECT_TRUE(action_for_key({key, {false, true}})) << key;
}

TEST(ViewInput, WheelUpComesNearer) {
  ViewState state = two_light_state();
  carry_out(state, zoom_for_scroll(2.0));
  EXPECT_LT(state.setup.camera->distance, 5.0);
  carry_out(state, zoom_for_scroll(-2.0));
  EXPECT_NEAR(state.setup.camera->distance, 5.0, 1e-7);  // steps keep nine digits
}

constexpr ImageSize pane{400, 200};

TEST(ViewInput, DragsTurnOnlyWhileAButtonIsDown) {
  Pointer pointer;
  EXPECT_FALSE(pointer.move_to(100.0, 100.0, pane));
  pointer.press(GLFW_MOUSE_BUTTON_LEFT);
  const auto orbit = pointer.move_to(110.0, 104.0, pane);
  ASSERT_TRUE(orbit && std::holds_alternative<OrbitBy>(*orbit));
  EXPECT_LT(std::get<OrbitBy>(*orbit).azimuth, 0.0);  // the eye goes left, so the scene follows the hand
  EXPECT_GT(std::get<OrbitBy>(*orbit).elevation, 0.0);
  EXPECT_FALSE(pointer.release(GLFW_MOUSE_BUTTON_LEFT));
  EXPECT_FALSE(pointer.move_to(0.0, 0.0, pane));
  pointer.press(GLFW_MOUSE_BUTTON_RIGHT);
  const auto turn = pointer.move_to(8.0, 0.0, pane);
  ASSERT_TRUE(turn && std::holds_alternative<TurnLightBy>(*turn));
}

TEST(ViewInput, AHandThatHardlyMovesClicks) {
  Pointer pointer;
  pointer.move_to(50.0, 50.0, pane);
  pointer.press(GLFW_MOUSE_BUTTON_LEFT);
  EXPECT_FALSE(pointer.move_to(51.0, 50.0, pane));
  EXPECT_TRUE(pointer.release(GLFW_MOUSE_BUTTON_LEFT));
}

TEST(ViewInput, ModifiersChooseWhatADragMoves) {
  EXPECT_EQ(drag_for(GLFW_MOUSE_BUTTON_LEFT, {}), Drag::turn_camera);
  EXPECT_EQ(drag_for(GLFW_MOUSE_BUTTON_LEFT, {true, false}), Drag::move_camera);
  EXPECT_EQ(drag_for(GLFW_MOUSE_BUTTON_LEFT, {false, true}), Drag::move_picture);
  EXPECT_EQ(drag_for(GLFW_MOUSE_BUTTON_MIDDLE, {}), Drag::move_camera);
  EXPECT_EQ(drag_for(GLFW_MOUSE_BUTTON_RIGHT, {}), Drag::turn_light);
}

}  // namespace
}  // namespace gnomon::app
