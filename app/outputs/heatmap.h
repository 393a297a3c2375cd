// What the rays of a picture cost, as a picture: boxes (nodes, cells, planes) or triangles tested per primary
// ray. The scale is fixed, so that any two heatmaps can be compared: viridis over the logarithm, from 0 (dark
// purple) to 4095 and more (yellow); a strip below the picture shows it, with a tick at each power of two.
#pragma once

#include <string>

#include "raytrace/tracer.h"
#include "scene/base/expected.h"
#include "scene/camera.h"

namespace gnomon::app {

enum class HeatmapOf : std::uint8_t { nodes, triangles };

/// The work of one primary ray per pixel, row 0 at the top.
Image<raytrace::WorkCounts> primary_ray_work(const raytrace::Tracer& tracer, const Camera& camera,
                                             ImageSize size);

/// Where a count lies on the scale, in [0, 1].
double heat_share(std::uint64_t count);

/// The heatmap with its legend below.
Rgb8Image heatmap_image(const Image<raytrace::WorkCounts>& work, HeatmapOf what);

/// .png: heatmap_image; .exr: both counts as they are (nodes.V, triangles.V).
Expected<void> write_heatmap(const std::string& path, const Image<raytrace::WorkCounts>& work,
                             HeatmapOf what);

}  // namespace gnomon::app
