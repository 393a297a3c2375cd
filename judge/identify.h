// Which of Gnomon's own settings comes nearest to a picture whose map is not known. One drawing of a map tells
// what every constant bias would draw of it (bias_curve.h), so that few are needed.
#pragma once

#include "compare/compare.h"
#include "compare/result/judged.h"

namespace gnomon::judge {

struct IdentifyOptions {
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  int bias_curve_points = 129;
};

/// `judged`: a comparison that judge_capture() made without a map. Puts the nearest setting's map and rungs
/// below the picture: V2 to V5 are then that model's, V6 stays the picture. Wrong pixels that the model draws
/// otherwise than the picture keep the label `unexplained`. Errors as of Renderer::render.
Expected<void> identify(compare::Comparison& judged, raster::Renderer& renderer,
                        const IdentifyOptions& options, const compare::Progress& progress = {});

/// The wrong pixels that a model draws otherwise than the picture get the label `unexplained`, and what is counted by
/// labels is counted again.
void mark_unexplained(const Image<float>& drawn_by_model, compare::LightComparison& light);
/// After labels have changed: other reasons for the same errors. What truth and picture alone decide, FLIP and SSIM among
/// it, stays.
void count_labels_again(compare::LightComparison& light);
/// Marks the given pixels as unexplained.
void mark_unexplained(const std::vector<std::uint32_t>& pixels, compare::LightComparison& light);

}  // namespace gnomon::judge
