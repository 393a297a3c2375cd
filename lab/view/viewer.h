// One window's life: what the keys, the mouse, the panels and the script ask for goes into the state; the render
// thread makes pictures of the state; they and the panels go on the screen, one frame after another. The window
// waits for nothing but the next event.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/view/script/script.h"
#include "lab/view/state/input.h"
#include "lab/view/state/presets.h"
#include "lab/view/state/projection.h"
#include "lab/view/state/state.h"
#include "lab/view/state/status.h"
#include "lab/view/view.h"
#include "lab/view/window/frame_watch.h"
#include "lab/view/window/interface.h"
#include "lab/view/window/layout.h"
#include "lab/view/window/window.h"
#include "lab/view/work/job.h"
#include "lab/view/work/meter.h"
#include "lab/view/work/render_thread.h"
#include "lab/view/work/scene_source.h"
#include "raster/gl/present.h"
#include "scene/base/timing.h"

namespace gnomon::lab {

/// Whether a script's step has to wait for pictures.
bool needs_time(const ScriptStep& step, const Snapshot& shown, const ViewState& state);

class Viewer {
 public:
  /// Opens the window. All must outlive the viewer.
  static Expected<std::unique_ptr<Viewer>> open(const ViewOptions& options, SceneSource source,
                                                ViewState state, std::vector<ScriptStep> script,
                                                app::Console& console);

  /// Until the window is closed or the script ends. Error: a script's step failed, or nothing can be drawn at
  /// all.
  Expected<void> run();

 private:
  Viewer(const ViewOptions& options, ViewState state, std::vector<ScriptStep> script, app::Console& console);
  Expected<RenderThread::MakeContext> choose_context();
  void listen();
  void press_key(const Key& key);
  void press(int button, bool down, const Modifiers& held);
  void move(double x, double y);
  void scroll(double notches, const Modifiers& held);
  void act(const Action& action);
  void carry_out_command(Command command);
  void follow_layout();
  /// When the preset's comparison is there: raises the bias as it asks, or says how much is seen.
  void finish_preset();
  Expected<void> take_snapshot();
  void show_scene(const OpenedScene& scene);
  void undo_change();
  void play_film();
  void post_changes();
  Expected<void> draw_frame();
  Expected<void> draw_pictures();
  Expected<void> draw_view(const ShownView& view);
  void draw_panels();
  void set_title();
  void sleep();
  TypeSize type() const;
  const Rgb8Image* picture(Picture view) const;
  /// Where the light's handle is on the window; nothing where no pane shows it.
  std::optional<Vec2> shown_handle() const;
  Readings readings() const;

  // Files and runs beside the window (viewer_files.cpp).
  void note(std::string_view text);
  void note(const Error& error);
  Expected<void> save_screenshot(const std::string& path);
  Expected<Rgb8Image> screenshot() const;
  void save_numbered(const std::string& start, const std::string& extension,
                     std::function<Expected<void>(const std::string&)> save, const std::string& remark = {});
  std::string left_out_words() const;
  std::string file_start(std::string_view kind) const;
  void save_numbered_screenshot();
  void save_picture();
  void save_scene();
  void copy_command();
  void print_command() const;
  std::vector<std::string> job_words(const std::string& command, const std::vector<std::string>& fixed,
                                     const std::vector<std::string>& of_view) const;
  void write_report();
  void find_best();
  void look_after_job();
  void use_answer(const Job& job);

  // The script (viewer_script.cpp).
  bool has_script() const { return !options_.script.empty(); }
  /// Makes the changes up to the next step that needs a frame or time.
  Expected<void> advance_script();
  /// Whether the step is over; called once before each frame.
  Expected<bool> pass(const ScriptStep& step);
  Expected<bool> pass_resize(const Resize& resize);
  Expected<bool> pass_open(const std::function<void()>& ask);
  Expected<bool> pass_film(const std::string& wanted);
  Expected<bool> pass_light(const std::string& wanted);
  Expected<bool> pass_drag(DragPointer drag);
  bool pass_point(Vec2 at);
  ScriptPointer& move_script_pointer(Vec2 to);
  bool pass_key(const Key& key);
  /// With the script's line, where there is one and the error does not name a place of its own.
  Error located(Error error, int line) const;

  ViewOptions options_;  ///< backend: the one that was taken; camera: of the scene that is shown
  app::Console& console_;
  ViewState state_;
  std::optional<Setup> drawable_;  ///< the last one that could be drawn
  std::uint64_t posted_ = 0;       ///< revision
  std::uint64_t scene_ = 0;        ///< OpenedScene::number
  bool quit_ = false;
  bool screenshot_asked_ = false;
  bool menu_asked_ = false;
  int busy_frames_ = 3;  ///< to be drawn before the window sleeps: panels settle over several frames
  std::string note_;
  /// Used last, while nothing else was changed and its comparison is not there.
  const Preset* preset_ = nullptr;
  bool preset_bias_raised_ = false;

  std::vector<ScriptStep> script_;
  std::size_t next_step_ = 0;
  int changed_line_ = 0;  ///< of the last step that changed the state; 0: none yet
  std::int64_t frames_waited_ = 0;
  std::optional<Stopwatch> resizing_;            ///< since the script asked for another size
  std::optional<std::uint64_t> opening_after_;   ///< the scene that was there when the script opened another
  std::optional<std::string> shot_after_frame_;  ///< the script's, to be taken when this frame is drawn
  std::optional<ScriptPointer> script_pointer_;
  std::optional<Key> script_key_;     ///< held down by the script
  std::optional<Vec2> dragged_from_;  ///< the light's handle, by a script
  Meter meter_;
  std::optional<Stopwatch> film_watch_;  ///< since the film's last moment

  std::unique_ptr<Window> window_;  ///< outlives all below
  std::unique_ptr<raster::Context> context_;
  std::unique_ptr<raster::Presenter> presenter_;
  std::unique_ptr<Interface> interface_;
  std::unique_ptr<RenderThread> thread_;
  std::shared_ptr<const Snapshot> shown_;
  std::unique_ptr<Job> job_;
  bool job_tunes_ = false;
  std::future<Expected<void>> saving_;  ///< a file that is written beside the window
  std::string saving_path_, saving_remark_;
  FrameWatch watch_;  ///< of this frame
  LabLayout layout_;
  Pointer pointer_;
  bool holds_swipe_ = false;                ///< the line of a swipe
  std::optional<ScreenCamera> held_light_;  ///< the light's handle, and the pane's camera when it was taken
  std::vector<Action> asked_;               ///< by the panels, in the frame that is drawn
  std::string title_;
};

}  // namespace gnomon::lab
