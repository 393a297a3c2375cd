// How long spans of drawing take on the device. Private to raster.
#pragma once

#include <optional>
#include <vector>

#include "raster/gl/gl.h"
#include "scene/base/timing.h"

namespace gnomon::raster {

/// Times one span of drawing after another. Where OpenGL has a clock of the device's own, it is taken (GL_TIME_ELAPSED; in a
/// browser EXT_disjoint_timer_query_webgl2, whose answers come after the caller's turn). Else the processor's clock is taken,
/// from an idle device to an idle device. It counts what the driver and the way to it take, too.
class SpanClock {
 public:
  /// Needs the context to be current, as all of it does.
  explicit SpanClock(Gl& gl);
  ~SpanClock();
  SpanClock(const SpanClock&) = delete;
  SpanClock& operator=(const SpanClock&) = delete;

  bool is_of_device() const { return of_device_; }
  /// Forgets the spans before.
  void restart();
  void begin();
  void end();
  /// Returns milliseconds of each span since restart(), once: none while one is not known yet; an empty list where the device
  /// lost count of them.
  std::optional<std::vector<double>> answer();

 private:
  Gl* gl_;
  bool of_device_;
  Stopwatch watch_;
  std::vector<GLuint> queries_;  ///< made so far; the first of them are of the spans
  std::size_t asked_ = 0;
  std::vector<double> clocked_ms_;
};

}  // namespace gnomon::raster
