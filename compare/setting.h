// What one comparison of many is made with: the cell of a sweep, the picture that a command's options ask for, and from where.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compare/compare.h"
#include "compare/path.h"

namespace gnomon::compare {

/// Everything that a cell of a sweep may change.
struct Setting {
  raster::RasterOptions raster;
  raytrace::RaytraceOptions raytrace;
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  Camera camera;
  std::vector<Light> lights;            ///< the scene's, of the same types; some may be left out
  std::vector<std::uint32_t> compared;  ///< indices in `lights`
};

/// One place that a setting is judged from.
struct JudgedView {
  std::string name;
  std::function<Pose(const Pose& own)> pose;  ///< what stands there, from the setting's own camera and lights
};

}  // namespace gnomon::compare
