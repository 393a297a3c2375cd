// One window's life: what the keys, the mouse and the script ask for goes into the state; what the studio
// draws of the state goes on the screen, one frame after another.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session.h"
#include "app/view/input.h"
#include "app/view/script.h"
#include "app/view/state.h"
#include "app/view/studio.h"
#include "app/view/view.h"
#include "app/view/window.h"
#include "raster/present.h"
#include "scene/timing.h"

namespace gnomon::app {

class Viewer {
 public:
  /// Opens the window. All must outlive the viewer.
  static Expected<std::unique_ptr<Viewer>> open(const ViewOptions& options, const LoadedScene& loaded,
                                                ViewState state, std::vector<ScriptStep> script,
                                                Console& console);

  /// Until the window is closed or the script ends. Error: a script's step failed, or nothing can be drawn at
  /// all.
  Expected<void> run();

 private:
  Viewer(const ViewOptions& options, const LoadedScene& loaded, ViewState state,
         std::vector<ScriptStep> script, Console& console);
  void listen();
  void act(const Action& action);
  void follow_window_size();
  Expected<void> update_pictures();
  void take_back();
  Expected<void> draw_frame();
  Expected<void> save_screenshot(const std::string& path);
  Expected<void> save_numbered_screenshot();
  void print_command() const;
  void sleep();

  // The script
  bool has_script() const { return !options_.script.empty(); }
  /// Makes the changes up to the next step that needs a frame or time.
  Expected<void> advance_script();
  /// Whether the step is over; called once before each frame.
  Expected<bool> pass(const ScriptStep& step);
  Expected<bool> pass_resize(const Resize& resize);
  /// With the script's line, where there is one and the error does not name a place of its own.
  Error located(Error error, int line) const;

  const ViewOptions& options_;
  const LoadedScene& loaded_;
  Console& console_;
  ViewState state_;
  std::optional<Setup> drawable_;  ///< the last one that could be drawn
  bool quit_ = false;
  bool screenshot_asked_ = false;

  std::vector<ScriptStep> script_;
  std::size_t next_step_ = 0;
  int changed_line_ = 0;  ///< of the last step that changed the state; 0: none yet
  std::int64_t frames_waited_ = 0;
  std::optional<Stopwatch> resizing_;            ///< since the script asked for another size
  std::optional<std::string> shot_after_frame_;  ///< the script's, to be taken when this frame is drawn

  std::unique_ptr<Window> window_;  ///< outlives all below
  std::unique_ptr<raster::Context> context_;
  std::unique_ptr<raster::Presenter> presenter_;
  std::unique_ptr<Studio> studio_;
  Pointer pointer_;
  std::string title_;
};

}  // namespace gnomon::app
