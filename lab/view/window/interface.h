// Dear ImGui in the window: its context, its backends, its font and style, one frame after another. It draws
// over what is in the window already and leaves OpenGL's state as it found it.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "lab/view/state/input.h"
#include "lab/view/state/look.h"
#include "lab/view/window/layout.h"
#include "lab/view/window/window.h"

namespace gnomon::lab {

/// A pointer that a script moves in place of the mouse.
struct ScriptPointer {
  double x = 0.0, y = 0.0;     ///< pixels of the window
  std::array<bool, 3> down{};  ///< left, right, middle
};

class Interface {
 public:
  /// After the window's own events are connected; the window must outlive it, its context be current.
  static Expected<std::unique_ptr<Interface>> open(const Window& window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Between two frames: colours and sizes.
  void use_type(const Look& look, const TypeSize& type);
  /// Before anything is drawn with Dear ImGui. `key`: held down by a script.
  void begin_frame(const std::optional<ScriptPointer>& pointer, const std::optional<Key>& key);
  /// Draws it all.
  void end_frame();

  /// The pointer is on a panel, or holds something there.
  bool wants_pointer() const;
  /// Somebody is typing, or moving through the panels by keyboard with a key that does that.
  bool wants_key(int glfw_key) const;
  /// Gives the keys back to the pictures; false when they have them.
  bool leave_panels();

 private:
  Interface() = default;
  std::optional<std::pair<Theme, double>> styled_;
  std::string font_;  ///< the file's bytes
  double font_scale_ = 0.0;
  std::optional<Key> script_key_;  ///< held down in the last frame
};

}  // namespace gnomon::lab
