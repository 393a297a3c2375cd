// The lab without a window. The engine is asked for a state by the words of a command line. It draws and compares that
// beside its callers, the newest wish first, and hands out what is there. Any number of threads may call it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lab/lab_options.h"
#include "lab/view/state/presets.h"
#include "lab/view/state/state.h"
#include "lab/view/work/render_thread.h"
#include "lab/view/work/scene_source.h"

namespace gnomon::lab {

/// What a page wants to see.
struct LabWish {
  std::string client;                   ///< the page's own name for itself: who asked last is told to all
  std::string scene;                    ///< a name or path as LabEngine::open_scene() takes it
  std::vector<std::string> words;       ///< options of `gnomon compare`, as a person would type them
  std::optional<std::size_t> preset{};  ///< of presets(): then the words are those that it begins with
};

/// What there is at one moment.
struct LabMoment {
  std::uint64_t number = 0;  ///< grows with everything that happens
  std::string client;        ///< who asked for it
  ViewState state;           ///< as it is drawn; revision 0: none yet
  LabOptions options;        ///< the state's words are made with
  std::shared_ptr<const Snapshot> shown;
  std::string scene;    ///< what a wish for the scene that is shown says; empty: there is none yet
  bool opening = true;  ///< another scene was asked for, or the first is not there yet
  std::string note;     ///< what a preset shows; empty: nothing
  std::string error;    ///< why the newest wish is not drawn; empty: it is, or will be
};

class LabEngine {
 public:
  /// `options`: what the command line asked for; `first`: its scene. Error: what it asks for cannot be.
  static Expected<std::unique_ptr<LabEngine>> start(const LabOptions& options, SceneSource first);

  /// Returns the number of the moment at which it was taken. Error (usage): the words are not understood, or the scene is none
  /// that may be opened; then nothing changes.
  Expected<std::uint64_t> ask(const LabWish& wish);
  /// Waits for a moment later than `after`; at the latest after `most` the moment as it is.
  LabMoment wait(std::uint64_t after, std::chrono::milliseconds most);
  /// Lets a file be opened by this name.
  void admit(const std::string& name, const std::string& path);
  /// "compare", "fence", "--size", ...: the words of the moment's state for a process of its own.
  std::vector<std::string> compare_words(const LabMoment& moment) const;

 private:
  LabEngine(const LabOptions& options, ViewState first);
  Expected<ViewState> state_of(const std::vector<std::string>& words, const OpenedScene& scene,
                               LabOptions& options) const;
  Expected<void> carry_out(const LabWish& wish, const OpenedScene& scene);
  std::string path_of(const std::string& scene) const;
  /// By which name the path may be opened.
  std::string name_of(const std::string& path) const;
  /// Whether the wish is for this scene, seen by this camera.
  bool is_of(const LabWish& wish, const OpenedScene& scene) const;
  void notice();
  /// The wish that a scene which is there now is drawn by: the one that waits for it, or that was carried out when it was opened
  /// before; else no words.
  LabWish wish_for(const OpenedScene& scene) const;
  void look_at(const Snapshot& shown);
  void finish_preset(const Snapshot& shown);
  void post();

  const LabOptions given_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<std::string, std::string>> admitted_;  ///< names, paths
  LabMoment now_;
  std::uint64_t revision_ = 0, scene_ = 0;  ///< scene_: OpenedScene::number
  std::optional<LabWish> waiting_;          ///< for its scene
  std::optional<LabWish> drawn_;            ///< carried out last
  std::string unreadable_;                  ///< what was last said of a scene
  const Preset* preset_ = nullptr;          ///< used last, while its comparison is not there
  bool preset_bias_raised_ = false;
  std::unique_ptr<RenderThread> thread_;  ///< last: it calls notice()
};

}  // namespace gnomon::lab
