#include "lab/view/state/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

namespace gnomon::lab {

namespace {

constexpr double orbit_step = 5.0, fine_orbit_step = 1.0;         // degrees
constexpr double light_step = 2.0, fine_light_step = 0.25;        // degrees
constexpr double bias_step = 1.0 / 16.0, coarse_bias_step = 1.0;  // texels
constexpr double slope_step = 0.125, coarse_slope_step = 1.0;     // multiples of the texel's depth slope
constexpr double offset_step = 0.125, coarse_offset_step = 1.0;   // texels
constexpr double pan_step = 1.0 / 16.0, swipe_step = 1.0 / 32.0;  // of the picture
constexpr int probe_step = 1, far_probe_step = 10;                // pixels
constexpr double click_pixels = 3.0;                              // a hand is not quite still
constexpr double degrees_per_pixel = 0.25;                        // of a drag

std::optional<Change> view_change(int key) {
  switch (key) {
    case GLFW_KEY_1:
      return Show{Picture::raster};
    case GLFW_KEY_2:
      return Show{Picture::raytrace};
    case GLFW_KEY_3:
      return Show{Picture::difference};
    case GLFW_KEY_4:
      return Show{Picture::labels};
    case GLFW_KEY_5:
      return Show{Picture::depth};
    case GLFW_KEY_6:
      return Show{Picture::truth};
    case GLFW_KEY_G:
      return Show{Picture::gap};
    case GLFW_KEY_T:
      return Show{Picture::texels};
    case GLFW_KEY_TAB:
      return ShowPrevious{};
    default:
      return std::nullopt;
  }
}

std::optional<Change> turning_change(int key, bool fine) {
  const double orbit = fine ? fine_orbit_step : orbit_step, light = fine ? fine_light_step : light_step;
  switch (key) {
    case GLFW_KEY_LEFT:
      return OrbitBy{-orbit, 0.0};
    case GLFW_KEY_RIGHT:
      return OrbitBy{orbit, 0.0};
    case GLFW_KEY_DOWN:
      return OrbitBy{0.0, -orbit};
    case GLFW_KEY_UP:
      return OrbitBy{0.0, orbit};
    case GLFW_KEY_PAGE_UP:
      return ZoomBy{1.0 / zoom_step};
    case GLFW_KEY_PAGE_DOWN:
      return ZoomBy{zoom_step};
    case GLFW_KEY_LEFT_BRACKET:
      return TurnLightBy{-light, 0.0};
    case GLFW_KEY_RIGHT_BRACKET:
      return TurnLightBy{light, 0.0};
    case GLFW_KEY_SEMICOLON:
      return TurnLightBy{0.0, -light};
    case GLFW_KEY_APOSTROPHE:
      return TurnLightBy{0.0, light};
    default:
      return std::nullopt;
  }
}

std::optional<Change> map_change(int key, bool coarse) {
  const double bias = coarse ? coarse_bias_step : bias_step, slope = coarse ? coarse_slope_step : slope_step;
  const double offset = coarse ? coarse_offset_step : offset_step;
  switch (key) {
    case GLFW_KEY_MINUS:
      return StepBias{-bias};
    case GLFW_KEY_EQUAL:
      return StepBias{bias};
    case GLFW_KEY_9:
      return StepSlopeBias{-slope};
    case GLFW_KEY_0:
      return StepSlopeBias{slope};
    case GLFW_KEY_7:
      return StepNormalOffset{-offset};
    case GLFW_KEY_8:
      return StepNormalOffset{offset};
    case GLFW_KEY_COMMA:
      return HalveMap{};
    case GLFW_KEY_PERIOD:
      return DoubleMap{};
    case GLFW_KEY_D:
      return NextDepthFormat{};
    case GLFW_KEY_K:
      return NextCull{};
    case GLFW_KEY_L:
      return NextLight{};
    case GLFW_KEY_F:
      return FreezeMaps{};
    case GLFW_KEY_R:
      return Reset{};
    default:
      return std::nullopt;
  }
}

std::optional<Change> look_change(int key, bool shift) {
  switch (key) {
    case GLFW_KEY_V:
      return NextLayout{};
    case GLFW_KEY_Z:
      return ZoomPicture{shift ? 0.5 : 2.0, {0.5, 0.5}};
    case GLFW_KEY_F2:
      return ToggleFlag{&Look::settings};
    case GLFW_KEY_F3:
      return ToggleFlag{&Look::results};
    case GLFW_KEY_F4:
      return ToggleFlag{&Look::large_type};
    case GLFW_KEY_F5:
      return NextTheme{};
    case GLFW_KEY_F11:
      return ToggleFlag{&Look::panels};
    case GLFW_KEY_H:
    case GLFW_KEY_F1:
      return ToggleFlag{&Look::help};
    case GLFW_KEY_X:
      return ProbePixel{};
    case GLFW_KEY_SPACE:
      return TogglePlay{};
    default:
      return std::nullopt;
  }
}

/// With ctrl: what the mouse moves otherwise.
std::optional<Change> moving_change(int key, bool shift) {
  const int pixels = shift ? far_probe_step : probe_step;
  const auto way = [shift](double right, double up) {
    return shift ? Change{StepPicture{pan_step * right, -pan_step * up}}
                 : Change{PanBy{pan_step * right, pan_step * up}};
  };
  switch (key) {
    case GLFW_KEY_LEFT:
      return way(-1.0, 0.0);
    case GLFW_KEY_RIGHT:
      return way(1.0, 0.0);
    case GLFW_KEY_DOWN:
      return way(0.0, -1.0);
    case GLFW_KEY_UP:
      return way(0.0, 1.0);
    case GLFW_KEY_I:
      return MoveProbe{0, -pixels};
    case GLFW_KEY_J:
      return MoveProbe{-pixels, 0};
    case GLFW_KEY_K:
      return MoveProbe{0, pixels};
    case GLFW_KEY_L:
      return MoveProbe{pixels, 0};
    case GLFW_KEY_COMMA:
      return SwipeBy{-swipe_step};
    case GLFW_KEY_PERIOD:
      return SwipeBy{swipe_step};
    default:
      return std::nullopt;
  }
}

std::optional<Action> control_action(int key) {
  switch (key) {
    case GLFW_KEY_S:
      return Command::save_scene;
    case GLFW_KEY_P:
      return Command::save_picture;
    case GLFW_KEY_C:
      return Command::copy_command;
    case GLFW_KEY_R:
      return Command::write_report;
    case GLFW_KEY_B:
      return Command::find_best;
    case GLFW_KEY_Q:
      return Command::quit;
    case GLFW_KEY_EQUAL:
      return Change{ScaleUi{1.25}};
    case GLFW_KEY_MINUS:
      return Change{ScaleUi{0.8}};
    case GLFW_KEY_0:
      return Change{SetUiScale{1.0}};
    default:
      return std::nullopt;
  }
}

std::optional<Command> command(int key) {
  switch (key) {
    case GLFW_KEY_P:
    case GLFW_KEY_F12:
      return Command::save_screenshot;
    case GLFW_KEY_C:
      return Command::copy_command;
    case GLFW_KEY_F10:
      return Command::open_menu;
    case GLFW_KEY_ESCAPE:
      return Command::leave;
    case GLFW_KEY_Q:
      return Command::quit;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Action> action_for_key(const Key& key) {
  const bool shift = key.held.shift;
  if (key.held.control) {
    if (const auto change = moving_change(key.code, shift)) return *change;
    return control_action(key.code);
  }
  if (const auto change = view_change(key.code)) return *change;
  if (const auto change = turning_change(key.code, shift)) return *change;
  if (const auto change = map_change(key.code, shift)) return *change;
  if (const auto change = look_change(key.code, shift)) return *change;
  if (key.code == GLFW_KEY_F6) return UsePreset{0};
  if (key.code == GLFW_KEY_F7) return UsePreset{1};
  if (key.code == GLFW_KEY_F8) return UsePreset{2};
  if (key.code == GLFW_KEY_F9) return UsePreset{3};
  if (const auto asked = command(key.code)) return *asked;
  return std::nullopt;
}

bool is_panel_key(const Key& key) {
  if (key.held.control) return key.code == GLFW_KEY_TAB;
  return key.code == GLFW_KEY_ENTER;
}

std::optional<Key> key_of_name(std::string_view name) {
  Key key;
  for (const auto& [prefix, flag] : {std::pair{std::string_view("ctrl+"), &Modifiers::control},
                                     std::pair{std::string_view("shift+"), &Modifiers::shift}}) {
    if (!name.starts_with(prefix)) continue;
    key.held.*flag = true;
    name.remove_prefix(prefix.size());
  }
  constexpr std::pair<std::string_view, int> named[] = {
      {"tab", GLFW_KEY_TAB},        {"esc", GLFW_KEY_ESCAPE},
      {"left", GLFW_KEY_LEFT},      {"right", GLFW_KEY_RIGHT},
      {"up", GLFW_KEY_UP},          {"down", GLFW_KEY_DOWN},
      {"pageup", GLFW_KEY_PAGE_UP}, {"pagedown", GLFW_KEY_PAGE_DOWN},
      {"F10", GLFW_KEY_F10},        {"F11", GLFW_KEY_F11},
      {"F12", GLFW_KEY_F12},        {"space", GLFW_KEY_SPACE},
      {"enter", GLFW_KEY_ENTER}};
  for (const auto& [text, code] : named)
    if (text == name) key.code = code;
  if (name.size() == 2 && name[0] == 'F' && name[1] >= '1' && name[1] <= '9')
    key.code = GLFW_KEY_F1 + name[1] - '1';
  // GLFW's codes of printable keys are their characters.
  if (name.size() == 1 && name[0] > ' ' && name[0] <= '~') key.code = static_cast<unsigned char>(name[0]);
  return key.code != 0 ? std::optional(key) : std::nullopt;
}

Change zoom_for_scroll(double notches) {
  return ZoomBy{std::pow(zoom_step, -notches)};
}

Drag drag_for(int button, const Modifiers& held) {
  if (button == GLFW_MOUSE_BUTTON_RIGHT) return Drag::turn_light;
  if (button == GLFW_MOUSE_BUTTON_MIDDLE) return Drag::move_camera;
  if (button != GLFW_MOUSE_BUTTON_LEFT) return Drag::none;
  return held.control ? Drag::move_picture : held.shift ? Drag::move_camera : Drag::turn_camera;
}

void Pointer::press(int button, const Modifiers& held) {
  drag_ = drag_for(button, held);
  button_ = button;
  moved_ = 0.0;
}

bool Pointer::release(int button) {
  if (button != button_) return false;
  drag_ = Drag::none;
  button_ = -1;
  return button == GLFW_MOUSE_BUTTON_LEFT && moved_ <= click_pixels;
}

std::optional<Change> Pointer::move_to(double x, double y, ImageSize pane) {
  const double right = x - x_, down = y - y_;
  x_ = x, y_ = y;
  moved_ += std::abs(right) + std::abs(down);
  // A hand that is not quite still is clicking.
  if (drag_ == Drag::none || moved_ <= click_pixels) return std::nullopt;
  switch (drag_) {
    case Drag::turn_camera:  // the scene follows the hand
      return OrbitBy{-right * degrees_per_pixel, down * degrees_per_pixel};
    case Drag::turn_light:
      return TurnLightBy{right * degrees_per_pixel, -down * degrees_per_pixel};
    case Drag::move_camera:
      return PanBy{-right / pane.height, down / pane.height};
    case Drag::move_picture:
      return MovePicture{-right / pane.width, -down / pane.height};
    case Drag::none:
      break;
  }
  return std::nullopt;
}

namespace {

constexpr KeyHelp view_keys[] = {{"1 2 3", "shadow map, ray traced, difference"},
                                 {"4 5 6", "labels, depth map, true shadow"},
                                 {"G  T", "gap, texels on receivers"},
                                 {"Tab", "the view before"},
                                 {"V", "one view, two with a line between, four"},
                                 {"Z, shift+Z", "enlarge the pictures, and back"},
                                 {"ctrl+ ,  .", "move the line between"},
                                 {"click, ctrl+I J K L", "explain a pixel, go up left down right"},
                                 {"X", "explain none"}};
constexpr KeyHelp move_keys[] = {{"left drag, arrows", "turn the camera (shift: finer)"},
                                 {"middle or shift+drag", "move the camera, as ctrl+arrows do"},
                                 {"wheel, page up/down", "come nearer, go away"},
                                 {"ctrl+wheel, ctrl+drag", "enlarge and move the pictures"},
                                 {"ctrl+shift+arrows", "move the enlarged pictures"},
                                 {"right drag, [ ] ; '", "turn the light (shift: finer)"},
                                 {"L", "next light"},
                                 {"space", "play the film, or stop it"}};
constexpr KeyHelp map_keys[] = {{"-  =", "bias"},
                                {"9  0", "slope bias"},
                                {"7  8", "normal offset (shift: coarser)"},
                                {",  .", "map size"},
                                {"D  K", "depth format, cull"},
                                {"F6 to F9", "show acne, peter-panning, aliasing, a leak"},
                                {"F", "freeze the map's camera, fly around it"},
                                {"ctrl+B", "search the best setting for this scene"},
                                {"R", "as at the start"}};
constexpr KeyHelp file_keys[] = {{"P, F12", "screenshot"},
                                 {"ctrl+P", "save the picture alone"},
                                 {"C", "copy and print the compare command"},
                                 {"ctrl+S", "save as scene"},
                                 {"ctrl+R", "write the report"}};
constexpr KeyHelp window_keys[] = {{"F1, H", "this help"},
                                   {"F2  F3", "settings, results"},
                                   {"F4  F5", "large type, dark or light"},
                                   {"ctrl+ = - 0", "larger, smaller, as the display says"},
                                   {"F11", "the pictures alone"},
                                   {"F10, ctrl+tab", "menus and panels by keyboard"},
                                   {"Esc", "leave the panel, stop a search, close"},
                                   {"Q", "quit"}};
constexpr KeyGroup groups[] = {{"Views", view_keys},
                               {"Camera and light", move_keys},
                               {"Shadow map", map_keys},
                               {"Files", file_keys},
                               {"Window", window_keys}};

}  // namespace

std::span<const KeyGroup> key_groups() {
  return groups;
}

}  // namespace gnomon::lab
