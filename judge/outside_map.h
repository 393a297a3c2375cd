// What lies outside a captured map: beside its window, or before and behind its depths. Nothing but the renderer's own choice
// lights or darkens it there.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// Tells whether a receiver lies before or behind the depths of the layers that hold its place, and the map has no depth to
/// compare it with. As for Gnomon's own maps it is outside then.
bool lies_beyond_depths(const raster::LightRecord& record, const raster::Bias& bias, const Light& light,
                        const raytrace::SurfacePoint& receiver, std::size_t pixel);

/// Tells whether a place lies behind the far plane of the layer that the pixel looks up. What is drawn there is the renderer's
/// own choice: it may clamp the depth, light what lies there or darken it.
bool lies_behind_far_plane(const raster::LightRecord& record, const Vec3& position, std::size_t pixel);

/// Finds what the picture tells of receivers that the renderer lights though its map shadows them. They lie behind the far
/// plane, or in the nearer half of depths of -1 to 1 that are tested from 0 on. They look nothing up then
/// (CapturedTest::faces).
void find_lit_depths(const FrameInput& input, raster::RasterFrame& frame, MapFacts& facts);

/// What is found outside the map.
struct OutsideFindings {
  std::vector<std::string> notes;  ///< what lies there, and what helps
  /// What helps, as a sentence of its own, where most wrong pixels lie outside.
  std::string cure;
};
OutsideFindings find_outside_map(const FrameInput& input, const compare::LightComparison& light,
                                 const raster::LightRecord& record);

}  // namespace gnomon::judge
