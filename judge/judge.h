// Another renderer's picture in the place of Gnomon's own: the same comparison, with that renderer's map, matrix
// and bias where the capture has them.
#pragma once

#include "compare/compare.h"
#include "compare/result/engines.h"
#include "compare/result/judged.h"
#include "judge/capture.h"

namespace gnomon::judge {

struct JudgeOptions {
  raytrace::RaytraceOptions raytrace;
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  bool fix = false;  ///< apply what mends the capture's conventions; false: such a capture is an error
  int bias_curve_points = 129;
  /// In whose settings advice is given, too; none: that which the renderer's name begins with.
  const compare::TunedEngine* engine = nullptr;
};

/// The light that the capture names, or the scene's only one. Error (bad input) where there is none, or none
/// is named and there are several.
Expected<std::uint32_t> captured_light(const Capture& capture, const Scene& scene);

/// `scene`: of `world`; its camera and light are changed by what --fix mends. Errors (bad input) as of
/// read_capture and align(); nothing is drawn by OpenGL.
Expected<compare::Comparison> judge_capture(const Capture& capture, Scene& scene, const World& world,
                                            const JudgeOptions& options,
                                            const compare::Progress& progress = {});

}  // namespace gnomon::judge
