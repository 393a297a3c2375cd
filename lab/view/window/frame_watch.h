// Where a frame of the window spends its time: every part of it by the clock on the wall and by the window's thread
// on a core. The difference is waiting: for a core, for the rasterizer's threads, for the display.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace gnomon::lab {

/// In the order of a frame; together they are all of it.
enum class FramePart : std::uint8_t {
  events,    ///< keys, the mouse, the script's steps
  snapshot,  ///< taking what the render thread has made, posting what it shall make
  pictures,  ///< putting the pictures on the window
  font,      ///< the text's font in another size
  panels,    ///< what the panels show, as triangles
  drawing,   ///< handing these to OpenGL
  swap,      ///< finishing the drawing, and bringing it to the display
};
inline constexpr std::size_t frame_part_count = 7;

class FrameWatch {
 public:
  struct Time {
    double wall_ms = 0.0, thread_ms = 0.0;  ///< thread_ms: of this thread on a core
  };
  FrameWatch() : mark_(now()) {}
  /// What went by since the part before ended belongs to this one.
  void end(FramePart part);
  /// What went by belongs to no frame.
  void leave_out() { mark_ = now(); }
  const Time& operator[](FramePart part) const { return times_[static_cast<std::size_t>(part)]; }
  Time sum() const;
  /// "swap 31 ms (4.1 ms), pictures 8.2 ms (3.0 ms), ...": the longest first, without what is below a millisecond.
  std::string words() const;

 private:
  static Time now();
  std::array<Time, frame_part_count> times_{};
  Time mark_;
};

}  // namespace gnomon::lab
