// What a comparison is made of: the options of both renderers, and where their frames come from.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/measure/subpixels.h"
#include "compare/measure/sums.h"
#include "raster/renderer.h"
#include "scene/base/expected.h"

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

/// Where the rows of a picture come from, as they are asked for: each band once, from the top.
struct FrameSource {
  std::function<Expected<raster::RasterFrame>(const PictureRows&)> draw;
  std::function<Expected<raytrace::RayTracedFrame>(const PictureRows&)> trace;
  /// All rungs of one light's pixels. Null: they are climbed from the frames.
  std::function<Climb(const LadderInput&)> climb{};
};

/// How a picture is measured.
struct Plan {
  const raytrace::Tracer& tracer;
  ImageSize picture;
  std::span<const std::uint32_t> lights;  ///< indices in Scene::lights, in the order of the frames' lists
  MeasureOptions measure{};
  std::span<const MapMeasures> maps{};           ///< by light, where they are known (MeasureOptions::map)
  const raytrace::Topology* topology = nullptr;  ///< of the tracer's world; null: made here
  /// From top to bottom. At most one: the picture in one piece, whose images stay in the comparison.
  std::vector<PictureRows> bands{};
  ErrorPlaces* places = nullptr;      ///< takes the errors of all lights; null: not asked for
  SubpixelSums* subpixels = nullptr;  ///< takes all lights' pixels; null: this is the picture itself
  // Of a picture in bands:
  bool page = true;      ///< whether the images that the report page shows are wanted
  std::string aov{};     ///< a path as aov_path() has it; "": not wanted
  std::string folder{};  ///< for what waits on the disk; "": the present one
};

/// The plan of a picture in one piece.
inline Plan plan_of(const raytrace::Tracer& tracer, std::span<const std::uint32_t> lights,
                    const CompareOptions& options) {
  return {.tracer = tracer,
          .picture = options.raster.size,
          .lights = lights,
          .measure = {.bias_curve_points = options.bias_curve_points, .perceptual = options.perceptual}};
}

}  // namespace gnomon::compare
