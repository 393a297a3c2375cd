// Keys and mouse as actions. Key codes are GLFW's, which name a key by its place on a US keyboard.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/view/state.h"

namespace gnomon::app {

/// What the window itself does, beside changing its state.
enum class Command : std::uint8_t { save_screenshot, print_command, print_help, quit };
using Action = std::variant<Change, Command>;

/// `shift`: coarse steps for the biases, fine ones for turning.
std::optional<Action> action_for_key(int glfw_key, bool shift);

/// One wheel notch up (y = 1) comes nearer.
Change zoom_for_scroll(double notches);

/// Left button drags the camera round, the right one the light. Positions in pixels.
class Pointer {
 public:
  void press(int glfw_button);
  void release(int glfw_button);
  /// The turn that moving here makes, if a button is down.
  std::optional<Change> move_to(double x, double y);

 private:
  double x_ = 0.0, y_ = 0.0;
  bool left_ = false, right_ = false;
};

/// Every key in words, for people.
std::string key_help();

}  // namespace gnomon::app
