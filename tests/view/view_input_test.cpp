// Keys, wheel and drags as actions.
#include "lab/view/state/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/support/places.h"
#include "tests/view/view_fixture.h"

namespace gnomon::lab {
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

TEST(ViewInput, KeysHaveNames) {
  EXPECT_EQ(key_of_name("B")->code, GLFW_KEY_B);
  EXPECT_EQ(key_of_name("=")->code, GLFW_KEY_EQUAL);
  EXPECT_EQ(key_of_name("F9")->code, GLFW_KEY_F9);
  EXPECT_EQ(key_of_name("F11")->code, GLFW_KEY_F11);
  EXPECT_TRUE(key_of_name("ctrl+S")->held.control);
  EXPECT_TRUE(key_of_name("shift+tab")->held.shift);
  EXPECT_FALSE(key_of_name("return"));
  EXPECT_FALSE(key_of_name("ctrl+"));
  EXPECT_TRUE(is_panel_key(*key_of_name("enter")));
  EXPECT_TRUE(is_panel_key(*key_of_name("ctrl+tab")));
  EXPECT_FALSE(is_panel_key(*key_of_name("tab")));
}

/// A key with what is held, and what it does: the state before and after.
struct Deed {
  const char* key;
  bool (*done)(const ViewState& before, const ViewState& after);
};

bool bias_differs(const ViewState& a, const ViewState& b) {
  return a.setup.map.bias.constant != b.setup.map.bias.constant;
}
bool slope_differs(const ViewState& a, const ViewState& b) {
  return a.setup.map.bias.slope != b.setup.map.bias.slope;
}
bool offset_differs(const ViewState& a, const ViewState& b) {
  return a.setup.map.bias.normal_offset_texels != b.setup.map.bias.normal_offset_texels;
}
bool camera_turns(const ViewState& a, const ViewState& b) {
  return posed_camera(a).eye != posed_camera(b).eye && posed_camera(a).target == posed_camera(b).target;
}
bool camera_moves(const ViewState& a, const ViewState& b) {
  return posed_camera(a).target != posed_camera(b).target;
}
bool light_turns(const ViewState& a, const ViewState& b) {
  return posed_light(a).direction != posed_light(b).direction;
}
bool picture_moves(const ViewState& a, const ViewState& b) {
  return a.look.middle != b.look.middle && !camera_moves(a, b);
}
bool line_moves(const ViewState& a, const ViewState& b) {
  return a.look.swipe != b.look.swipe && a.setup.map == b.setup.map;
}
bool zoom_differs(const ViewState& a, const ViewState& b) {
  return a.look.zoom != b.look.zoom;
}
bool scale_differs(const ViewState& a, const ViewState& b) {
  return a.look.ui_scale != b.look.ui_scale;
}
template <Picture picture>
bool shows(const ViewState&, const ViewState& after) {
  return after.picture == picture;
}
template <bool Look::*flag>
bool toggles(const ViewState& a, const ViewState& b) {
  return a.look.*flag != b.look.*flag;
}
template <int right, int down>
bool probe_moves(const ViewState& a, const ViewState& b) {
  return b.look.probe == PixelPlace{a.look.probe->x + right, a.look.probe->y + down};
}

constexpr Deed deeds[] = {
    {"1", shows<Picture::raster>},
    {"2", shows<Picture::raytrace>},
    {"3", shows<Picture::difference>},
    {"4", shows<Picture::labels>},
    {"5", shows<Picture::depth>},
    {"6", shows<Picture::truth>},
    {"G", shows<Picture::gap>},
    {"T", shows<Picture::texels>},
    {"tab", [](const auto& a, const auto& b) { return b.picture == a.previous && b.previous == a.picture; }},
    {"V", [](const auto& a, const auto& b) { return a.look.layout != b.look.layout; }},
    {"F", [](const auto& a, const auto& b) { return b.setup.map_camera == posed_camera(a); }},
    {"Z", zoom_differs},
    {"shift+Z", zoom_differs},
    {"ctrl+,", line_moves},
    {"ctrl+.", line_moves},
    {"ctrl+shift+left", picture_moves},
    {"ctrl+shift+right", picture_moves},
    {"ctrl+shift+up", picture_moves},
    {"ctrl+shift+down", picture_moves},
    {"X", [](const auto& a, const auto& b) { return a.look.probe && !b.look.probe; }},
    {"ctrl+I", probe_moves<0, -1>},
    {"ctrl+J", probe_moves<-1, 0>},
    {"ctrl+K", probe_moves<0, 1>},
    {"ctrl+L", probe_moves<1, 0>},
    {"ctrl+shift+L", probe_moves<10, 0>},
    {"left", camera_turns},
    {"right", camera_turns},
    {"up", camera_turns},
    {"down", camera_turns},
    {"ctrl+left", camera_moves},
    {"ctrl+right", camera_moves},
    {"ctrl+up", camera_moves},
    {"ctrl+down", camera_moves},
    {"pageup", camera_turns},
    {"pagedown", camera_turns},
    {"[", light_turns},
    {"]", light_turns},
    {";", light_turns},
    {"'", light_turns},
    {"L", [](const auto& a, const auto& b) { return a.setup.light != b.setup.light; }},
    {"space", [](const auto& a, const auto& b) { return a.film.plays != b.film.plays; }},
    {"-", bias_differs},
    {"=", bias_differs},
    {"9", slope_differs},
    {"0", slope_differs},
    {"7", offset_differs},
    {"8", offset_differs},
    {",", [](const auto& a, const auto& b) { return 2 * b.setup.map.size == a.setup.map.size; }},
    {".", [](const auto& a, const auto& b) { return b.setup.map.size == 2 * a.setup.map.size; }},
    {"D", [](const auto& a, const auto& b) { return a.setup.map.depth_format != b.setup.map.depth_format; }},
    {"K", [](const auto& a, const auto& b) { return a.setup.map.cull != b.setup.map.cull; }},
    {"R",
     [](const auto& a, const auto& b) { return b.setup.map == a.initial.map && a.setup.map != b.setup.map; }},
    {"F1", toggles<&Look::help>},
    {"H", toggles<&Look::help>},
    {"F2", toggles<&Look::settings>},
    {"F3", toggles<&Look::results>},
    {"F4", toggles<&Look::large_type>},
    {"F5", [](const auto& a, const auto& b) { return a.look.theme != b.look.theme; }},
    {"F11", toggles<&Look::panels>},
    {"ctrl+=", scale_differs},
    {"ctrl+-", scale_differs},
    {"ctrl+0", scale_differs}};

constexpr std::pair<const char*, Command> commands[] = {{"P", Command::save_screenshot},
                                                        {"F12", Command::save_screenshot},
                                                        {"ctrl+P", Command::save_picture},
                                                        {"C", Command::copy_command},
                                                        {"ctrl+C", Command::copy_command},
                                                        {"ctrl+S", Command::save_scene},
                                                        {"ctrl+R", Command::write_report},
                                                        {"ctrl+B", Command::find_best},
                                                        {"esc", Command::leave},
                                                        {"F10", Command::open_menu},
                                                        {"Q", Command::quit},
                                                        {"ctrl+Q", Command::quit}};
constexpr const char* preset_keys[] = {"F6", "F7", "F8", "F9"};

/// Returns a state of which every key changes something.
ViewState busy_state() {
  ViewState state = two_light_state();
  state.given.films = {LabFilm{}};
  state.given.lights[0].direction = glm::normalize(Vec3(1.0, -2.0, 0.5));
  carry_out(state, SetMapOption{"bias", "3texel"});
  carry_out(state, SetMapOption{"slope-bias", "2"});
  carry_out(state, SetMapOption{"normal-offset", "1"});
  carry_out(state, SetMapOption{"map-size", "512"});
  carry_out(state, ZoomPictureTo{4.0});
  carry_out(state, ProbePixel{PixelPlace{50, 60}});
  carry_out(state, SetUiScale{2.0});
  carry_out(state, Show{Picture::difference});
  carry_out(state, Show{Picture::labels});
  carry_out(state, Show{Picture::texels});
  return state;
}

TEST(ViewInput, EveryKeyDoesWhatItSays) {
  for (const Deed& deed : deeds) {
    const auto key = key_of_name(deed.key);
    const auto action = key ? action_for_key(*key) : std::nullopt;
    ASSERT_TRUE(action && std::holds_alternative<Change>(*action)) << deed.key;
    const ViewState before = busy_state();
    ViewState after = before;
    if (std::string_view(deed.key) == "T") carry_out(after, Show{Picture::raster});
    carry_out(after, std::get<Change>(*action));
    EXPECT_TRUE(deed.done(before, after)) << deed.key;
  }
  for (const auto& [name, command] : commands) {
    const auto action = action_for_key(*key_of_name(name));
    ASSERT_TRUE(action && std::holds_alternative<Command>(*action)) << name;
    EXPECT_EQ(std::get<Command>(*action), command) << name;
  }
  for (std::size_t i = 0; i < std::size(preset_keys); ++i) {
    const auto action = action_for_key(*key_of_name(preset_keys[i]));
    ASSERT_TRUE(action && std::holds_alternative<UsePreset>(*action)) << preset_keys[i];
    EXPECT_EQ(std::get<UsePreset>(*action).preset, i);
  }
}

/// Reads the first column of the table below "## Keys and mouse": what stands between bars, commas and blanks.
std::set<std::string> documented_keys() {
  std::ifstream file(test::source_dir() + "/docs/lab.md");
  std::set<std::string> keys;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## ")) inside = line == "## Keys and mouse";
    if (!inside || !line.starts_with("| ")) continue;
    std::istringstream words(line.substr(2, line.find(" |") - 2));
    for (std::string word; words >> word;) {
      if (word.size() > 1 && (word.back() == ',' || word.back() == ';') && word != "ctrl+,") word.pop_back();
      keys.insert(word);
    }
  }
  return keys;
}

/// No key does anything that neither this test nor the manual knows.
TEST(ViewInput, EveryKeyThatDoesSomethingIsInTheManual) {
  std::set<std::string> known;
  for (const Deed& deed : deeds) known.insert(deed.key);
  for (const auto& [name, command] : commands) known.insert(name);
  for (const char* name : preset_keys) known.insert(name);
  std::vector<std::string> names;
  for (char c = '!'; c <= '~'; ++c) names.emplace_back(1, c);
  for (int i = 1; i <= 12; ++i) names.push_back("F" + std::to_string(i));
  for (const char* name :
       {"tab", "esc", "left", "right", "up", "down", "pageup", "pagedown", "space", "enter"})
    names.emplace_back(name);
  for (const std::string& name : names)
    for (const char* held : {"", "ctrl+"}) {
      const auto key = key_of_name(held + name);
      const bool acts = key && action_for_key(*key);
      EXPECT_TRUE(!acts || known.contains(held + name)) << held << name;
    }
  const std::set<std::string> written = documented_keys();
  for (std::string name : known) {
    for (const char* arrow : {"left", "right", "up", "down"})
      if (name.ends_with(arrow)) name.replace(name.size() - std::strlen(arrow), std::string::npos, "arrows");
    if (name == "tab" || name == "esc") name[0] = static_cast<char>(std::toupper(name[0]));
    if (name.starts_with("page")) name = name.substr(4);
    if (name.starts_with("ctrl+shift+") && name.size() == 12) continue;  // said beside the one without shift
    EXPECT_TRUE(written.contains(name)) << name;
  }
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
}  // namespace gnomon::lab
