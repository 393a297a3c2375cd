// The main job: one scene through both renderers and up the ladder.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "compare/comparison.h"
#include "raster/renderer.h"
#include "scene/expected.h"

namespace gnomon::compare {

struct CompareOptions {
  raster::RasterOptions raster;
  raytrace::RaytraceOptions raytrace;
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  int bias_curve_points = 129;
  bool perceptual = true;  ///< FLIP and SSIM; NaN when left out
};

/// Called as work proceeds with a stage name and the share done in [0, 1].
using Progress = std::function<void(std::string_view stage, double done)>;

/// What is asked of the rasterizer, so that it samples lights as the ray tracer does.
raster::RasterOptions drawing_options(raster::RasterOptions drawing, const raytrace::RaytraceOptions& traced);

/// Traces what was drawn so, and compares the lights of those indices. `tracer` is of `options`.
Expected<Comparison> compare_drawn(const raytrace::Tracer& tracer, raster::RasterFrame drawn,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress = {});

/// Draws, and compares. The renderer must have been created for `world`.
Expected<Comparison> compare_world(const World& world, raster::Renderer& renderer,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress = {});

/// Compares two finished frames of the same world, camera and size (the viewer's entry). `topology_ms`
/// receives what joining the triangles took, which only labels need.
Expected<std::vector<LightComparison>> compare_frames(const World& world, const raytrace::Tracer& tracer,
                                                      const raster::RasterFrame& drawn,
                                                      const raytrace::RayTracedFrame& truth,
                                                      const CompareOptions& options,
                                                      double* topology_ms = nullptr);

}  // namespace gnomon::compare
