// A thread that draws and compares as the window's does, and scenes for it in files of their own. For tests that need no
// window.
#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>
#include <set>

#include "lab/view/work/render_thread.h"

namespace gnomon::lab {

inline constexpr ImageSize lab_size{64, 48};

/// A studio of its own thread, and the last snapshot that it gave.
class Lab {
 public:
  /// `may_begin`: before that the thread makes no context.
  Lab(const std::string& scene, const std::string& shaders, const std::shared_future<void>& may_begin = {}) {
    options_.compare.perceptual = false;
    options_.shader_folder = shaders;
    auto source = read_source({scene, false}, {}, options_);
    if (!source) {
      ADD_FAILURE() << source.error().message();
      return;
    }
    const auto context = [may_begin] {
      if (may_begin.valid()) may_begin.wait();
      return raster::create_context(raster::Backend::automatic);
    };
    thread_ = std::make_unique<RenderThread>(context, std::move(*source), options_, [this] {
      {
        const std::lock_guard lock(mutex_);
        woken_ = true;
        if (thread_) drawn_.insert(thread_->snapshot()->live.revision);
      }
      changed_.notify_one();
    });
  }

  /// The first snapshot of which this is true.
  template <class Condition>
  std::shared_ptr<const Snapshot> until(const Condition& condition) {
    for (;;) {
      auto snapshot = thread_->snapshot();
      if (condition(*snapshot)) return snapshot;
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return woken_; });
      woken_ = false;
    }
  }

  RenderThread& thread() { return *thread_; }

  /// The revisions of all pictures that were published; 0: none yet.
  std::set<std::uint64_t> drawn() {
    const std::lock_guard lock(mutex_);
    return drawn_;
  }

  /// A state of the scene that is open.
  ViewState state(const Snapshot& shown) const {
    ViewState state;
    state.given = shown.scene->given;
    state.setup.lights.resize(state.given.lights.size());
    state.setup.size = lab_size;
    state.setup.map.size = 128;
    state.initial = state.setup;
    return state;
  }

 private:
  StudioOptions options_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  std::set<std::uint64_t> drawn_;
  std::unique_ptr<RenderThread> thread_;
};

inline bool is_open(const Snapshot& shown) {
  return shown.scene != nullptr;
}

/// Whole under its name, or not at all.
inline void write_whole(const std::string& path, const std::string& text) {
  std::ofstream(path + ".new", std::ios::binary) << text;
  std::filesystem::rename(path + ".new", path);
}

inline constexpr const char* plain_scene = R"({"schema": "gnomon/scene/1", "name": "plain",
  "camera": {"eye": [0, 3, 5], "target": [0, 0, 0]},
  "lights": [{"name": "sun", "type": "directional", "elevation_degrees": 50, "azimuth_degrees": 30}],
  "materials": [{"name": "grey"}],
  "shapes": [{"material": "grey", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}},
             {"material": "grey", "sphere": {"center": [0, 1.5, 0], "radius": RADIUS}}]})";

inline std::string scene_with_radius(const char* radius) {
  std::string text = plain_scene;
  return text.replace(text.find("RADIUS"), 6, radius);
}

}  // namespace gnomon::lab
