// How quickly the window answers. It measures the longest frame, and the time from a change of the setup to its
// picture, its labels at a quarter of the size, and its labels in full.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/view/window/frame_watch.h"
#include "lab/view/work/render_thread.h"
#include "scene/base/timing.h"

namespace gnomon::lab {

class Meter {
 public:
  /// One is over.
  void frame(const FrameWatch& watch);
  /// An order was posted.
  void posted(std::uint64_t revision);
  /// A frame with this snapshot has reached the screen.
  void shown(const Snapshot& snapshot);
  /// "812 frames, the longest 21 ms (swap 14 ms (3 ms), ...), 0 over 50 ms; ..."
  std::string words() const;

 private:
  struct Answer {
    std::vector<double> ms;
    bool waiting = false;
    void arrived(double elapsed_ms);
    std::string words(const char* what) const;
  };
  Stopwatch since_post_;
  std::uint64_t revision_ = 0, frames_ = 0, posts_ = 0;
  FrameWatch longest_;
  std::uint64_t long_frames_ = 0;
  Answer picture_, preview_, full_;
};

}  // namespace gnomon::lab
