// The thread that draws and compares: it owns the studio, so that the window never waits for a picture. The
// window posts what it wants, of which the newest wins, and reads what is there as snapshots that never change.
// What takes longer than two seconds to draw is left when something newer waits, and a scene that is read when another one does.
// The thread also looks after the scene's files and the shader folder, and reads them again when they change.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "lab/view/work/file_watch.h"
#include "lab/view/work/scene_source.h"
#include "lab/view/work/studio.h"
#include "lab/view/work/turns.h"
#include "scene/base/timing.h"

namespace gnomon::lab {

/// A scene as it was opened.
struct OpenedScene {
  std::uint64_t number = 0;  ///< grows with each scene that is opened or read again
  bool again = false;        ///< the same as before, read again: what was set stays set
  app::SceneArgument argument;
  std::string camera;  ///< SceneSource::camera
  std::string name;
  GivenScene given;
  std::size_t lights_left_out = 0;  ///< by --max-lights
  raster::MapOptions map;           ///< what a lesson or the file asks for, else the defaults
};

/// What there is to show, at one moment.
struct Snapshot {
  std::shared_ptr<const OpenedScene> scene;
  LivePicture live;
  std::shared_ptr<const ComparisonOutcome> outcome;
  std::shared_ptr<const ShadowTimes> shadow_times;  ///< Studio::shadow_times()
  int max_map_size = 0;
  std::string renderer;  ///< GL_RENDERER
  struct Failure {
    std::uint64_t revision = 0;
    Error error;
  };
  std::optional<Failure> undrawable;    ///< this revision cannot be drawn
  std::optional<Failure> incomparable;  ///< this one cannot be compared
  std::optional<Error>
      unreadable;  ///< the scene or the shaders as they are now; the last good ones are shown
  bool opening = false;

  bool is_drawn(const ViewState& state) const { return live.revision == state.revision; }
  bool is_done(const ViewState& state) const {
    return is_drawn(state) && outcome && !outcome->preview && outcome->revision == state.revision;
  }
};

/// Returns the newest picture of that kind; before the first comparison that of the shadow map, or null before it.
const Rgb8Image* picture_of(const Snapshot& shown, Picture view);

class RenderThread {
 public:
  using MakeContext = std::function<Expected<std::unique_ptr<raster::Context>>()>;
  /// `context` is called on the thread, for each scene; `wake` from it whenever there is a new snapshot.
  RenderThread(MakeContext context, SceneSource first, StudioOptions options, std::function<void()> wake);
  ~RenderThread();

  /// Draws and compares this next. Orders for another scene than `scene` (OpenedScene::number) are dropped.
  void post(std::uint64_t scene, DrawOrder order);
  /// Reads another scene, seen by one of its cameras (empty: the first); until it is there the one before stays.
  void open(app::SceneArgument scene, std::string camera = {});
  std::shared_ptr<const Snapshot> snapshot() const;
  /// One that is not needed any longer, to be freed on this thread: giving memory back takes time.
  void give_back(std::shared_ptr<const Snapshot> snapshot);

 private:
  struct Task {
    std::optional<std::pair<app::SceneArgument, std::string>> open;  ///< with a camera
    std::optional<DrawOrder> order;
    bool quit = false;
  };
  bool turn(bool wait);
  void first_turn();
  void work_on(const Task& task);
  void give_up(const std::exception& error);
  Task next_task(bool wait);
  /// Nothing where it was left for another scene.
  std::optional<Expected<SceneSource>> read(const app::SceneArgument& argument, const std::string& camera);
  void read_scene(const app::SceneArgument& argument, const std::string& camera, bool again);
  void install(const SceneSource& source, bool again);
  Expected<std::unique_ptr<Studio>> make_studio(const SceneSource& source, bool& again);
  void read_changed_files();
  void carry_out(const DrawOrder& order);
  /// Whether what is drawn is not worth its end: something newer waits, and it has taken seconds already.
  bool is_overtaken() const;
  void publish();
  void wake_thread();

  MakeContext context_;
  StudioOptions options_;
  std::function<void()> wake_;
  std::optional<SceneSource> first_;

  // The thread's own.
  std::unique_ptr<Studio> studio_;
  FileWatch scene_files_, shader_files_;
  Snapshot now_;
  std::optional<DrawOrder> last_order_;
  Stopwatch since_order_;     ///< since the last one was begun
  bool must_finish_ = false;  ///< what is drawn
  bool gave_up_ = false;
  bool only_said_ = false;  ///< what is unreadable is another scene than the one that is shown

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::pair<app::SceneArgument, std::string>> asked_scene_;
  std::optional<std::pair<std::uint64_t, DrawOrder>> asked_order_;
  bool finished_ = false;  ///< a comparison has finished
  std::atomic<bool> quit_ = false;
  std::atomic<bool> newer_waits_ = false;        ///< asked_scene_ or asked_order_
  std::optional<std::string> reads_;             ///< the scene that is read
  std::atomic<bool> other_scene_waits_ = false;  ///< than the one that is read
  std::shared_ptr<const Snapshot> published_;
  std::vector<std::shared_ptr<const Snapshot>> given_back_;
  Turns turns_;  ///< last
};

}  // namespace gnomon::lab
