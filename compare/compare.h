// The main job: one scene through both renderers and up the ladder.
#pragma once

#include "compare/measure/measure.h"

namespace gnomon::compare {

/// Draws, traces and compares a picture in one piece. The renderer must have been created for `world`.
Expected<Comparison> compare_world(const World& world, raster::Renderer& renderer,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress = {});

}  // namespace gnomon::compare
