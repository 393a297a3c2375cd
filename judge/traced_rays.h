// What is wrong with the shadows of another ray tracer, which has no map. Rays may start below their own surface
// (self-intersection) or beyond a caster (too large an offset). Or it is the shadow terminator. Gnomon's own rays from
// places beside the receiver tell them apart.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// Counts of wrong pixels, and what they were told by.
struct TracedFinding {
  std::size_t wrong = 0;              ///< pixels with an error, those of the light's size aside
  std::size_t self_intersection = 0;  ///< speckles on a lit surface; label acne
  std::size_t terminator = 0;         ///< dark where the smooth normal faces away; label acne
  std::size_t too_far = 0;            ///< lit though a caster is nearer than `skipped`; label peter-panning
  double skipped = 0.0;               ///< world units: casters nearer than that along the ray are not met
  /// World units: what the two roundings of a place to 32 bits move a receiver along its normal by, at most; an offset of so
  /// much keeps a ray above its surface.
  double offset = 0.0;
  double spacing = 0.0;      ///< world units between neighbouring places of 32 bits there
  double from_origin = 0.0;  ///< of these pixels, median
  std::size_t left =
      0;  ///< pixels that Gnomon's own rays from that offset see otherwise than from the surface
};

/// Gives labels to pixels of `light` that are unexplained, and makes its rungs say the step: slope for acne, bias for
/// peter-panning.
TracedFinding label_traced_rays(const FrameInput& input, compare::LightComparison& light);

std::vector<std::string> traced_notes(const TracedFinding& found);
/// What to do, as one sentence; empty: nothing is known.
std::string traced_advice(const TracedFinding& found, const compare::LightComparison& light);

}  // namespace gnomon::judge
