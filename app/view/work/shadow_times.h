// What a light's shadows take on the GPU, beside what exact ones take by rays. Drawn and timed only while nothing else is to be
// done, so that neither pictures nor labels wait for it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "raster/renderer.h"
#include "scene/base/time_difference.h"

namespace gnomon::app {

/// Milliseconds of one drawing, run by run: the mean of `drawings` of them.
struct ShadowTimes {
  std::uint64_t revision = 0;  ///< of the state that was drawn
  bool by_device = false;  ///< by the GPU's own clock; else by the processor's, with the wait for the driver
  int drawings = 0;
  double step_ms = 0.0;  ///< the clock's: every time of a run's drawings together is a multiple of it
  Times map, shaded, unshadowed;

  /// What the picture's shading takes with the shadows beyond what it takes without.
  TimeDifference lookups() const { return beyond_part(shaded, unshadowed); }
  /// A frame's whole share: with the map drawn anew.
  TimeDifference map_and_lookups() const;
};

class ShadowTimer {
 public:
  /// Draws the map, the picture and the picture without shadows so often, and has that timed (RasterOptions::span_drawings).
  using Draw = std::function<Expected<void>(int drawings)>;

  /// Takes what the device has told since, or asks it for the next; does nothing when all of this revision is known. A run that the
  /// device lost count of is made again.
  Expected<void> take_turn(std::uint64_t revision, raster::Renderer& renderer, const Draw& draw);
  /// The newest of which all runs are known; null: none yet.
  std::shared_ptr<const ShadowTimes> times() const { return known_; }

 private:
  void take(const raster::ShadowSpans& spans);

  ShadowTimes now_;
  bool asked_ = false;
  std::int64_t step_us_ = 0;
  std::shared_ptr<const ShadowTimes> known_;
};

}  // namespace gnomon::app
