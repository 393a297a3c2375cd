// What a light's shadows take of the rasterizer, beside what exact ones take by rays. Drawn and timed only while nothing else is
// to be done, so that neither pictures nor labels wait for it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "raster/renderer.h"
#include "scene/base/time_difference.h"

namespace gnomon::lab {

/// Milliseconds of one drawing, run by run: on a GPU the mean of `drawings` of them.
struct ShadowTimes {
  std::uint64_t revision = 0;  ///< of the state that was drawn
  bool by_device = false;  ///< by the GPU's own clock; else by the processor's, with the wait for the driver
  int drawings = 0;
  double step_ms =
      0.0;  ///< the clock's: every time of a run's drawings together is a multiple of it; 0: of the processor
  Times map;
  std::vector<TimedStrip> strips;  ///< the picture shaded, and shaded without shadows

  /// What the picture's shading takes with the shadows beyond what it takes without.
  TimeDifference lookups() const { return beyond_part(strips); }
};

class ShadowTimer {
 public:
  /// Draws the map, the picture and the picture without shadows so often, and has that timed (RasterOptions::span_drawings).
  using Draw = std::function<Expected<void>(int drawings)>;

  /// Takes what the device has told since, or asks it for the next; does nothing when all of this revision is known. A run that the
  /// device lost count of is made again.
  Expected<void> take_turn(std::uint64_t revision, raster::Renderer& renderer, const Draw& draw);
  /// Takes what was drawn and timed in software. Nothing happens when all of this revision is known.
  void take_run(std::uint64_t revision, const raster::LightRecord& drawn);
  bool knows(std::uint64_t revision) const { return known_ && known_->revision == revision; }
  /// The newest of which all runs are known; null: none yet.
  std::shared_ptr<const ShadowTimes> times() const { return known_; }

 private:
  void begin(std::uint64_t revision);
  void take(const raster::ShadowSpans& spans);

  ShadowTimes now_;
  bool asked_ = false;
  std::int64_t step_us_ = 0;
  std::shared_ptr<const ShadowTimes> known_;
};

}  // namespace gnomon::lab
