// Keys and mouse as actions. Key codes are GLFW's, which name a key by its place on a US keyboard.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lab/view/state/state.h"

namespace gnomon::lab {

/// Modifier keys that are held.
struct Modifiers {
  bool shift = false, control = false;
};
struct Key {
  int code = 0;  ///< GLFW's
  Modifiers held{};
};

/// What the window itself does, beside changing its state.
enum class Command : std::uint8_t {
  save_screenshot,
  save_picture,
  copy_command,
  save_scene,
  write_report,
  find_best,
  stop_job,
  open_menu,
  leave,
  quit
};
/// Another scene: a file, a built-in scene or a lesson.
struct OpenScene {
  std::string name;
};
/// One of presets().
struct UsePreset {
  std::size_t preset;
};
using Action = std::variant<Change, Command, OpenScene, UsePreset>;

/// Shift: coarse steps for the biases, fine ones for turning.
std::optional<Action> action_for_key(const Key& key);

/// Keys that move through menus and panels and do nothing else: enter, ctrl+tab.
bool is_panel_key(const Key& key);

/// "B", "5", "F6", "ctrl+B", "shift+Z", "tab", "esc", "left": nothing for other words.
std::optional<Key> key_of_name(std::string_view name);

/// One wheel notch up (y = 1) comes nearer.
Change zoom_for_scroll(double notches);
inline constexpr double zoom_step = 1.1;  ///< of a notch

/// What a drag over the pictures does.
enum class Drag : std::uint8_t { none, turn_camera, turn_light, move_camera, move_picture };
/// By button and modifier keys; GLFW's buttons.
Drag drag_for(int glfw_button, const Modifiers& held);

/// Left button drags the camera round, the right one the light, the middle one (or left with shift) moves the
/// camera, left with control the enlarged picture. Positions in pixels.
class Pointer {
 public:
  void press(int glfw_button, const Modifiers& held = {});
  /// Whether this was a click: the button came up where it went down.
  bool release(int glfw_button);
  /// What moving here makes, if a button is down. `pane`: pixels of the picture's place on the screen.
  std::optional<Change> move_to(double x, double y, ImageSize pane);
  Vec2 place() const { return {x_, y_}; }

 private:
  double x_ = 0.0, y_ = 0.0;
  Drag drag_ = Drag::none;
  int button_ = -1;
  double moved_ = 0.0;  ///< since the press, pixels
};

/// Every key in words, by subject, for people.
struct KeyHelp {
  std::string_view keys, what;
};
struct KeyGroup {
  std::string_view title;
  std::span<const KeyHelp> keys;
};
std::span<const KeyGroup> key_groups();

}  // namespace gnomon::lab
