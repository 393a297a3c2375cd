// LDR-FLIP: how different two images look when flipped between, per pixel in [0, 1].
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A Difference Evaluator for
// Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2). Constants and section numbers are the
// paper's.
#pragma once

#include "scene/image.h"

namespace gnomon::compare {

/// A 0.7 m wide screen of 3840 pixels seen from 0.7 m (section 4.1).
inline constexpr double flip_pixels_per_degree = 67.0206;

/// The error of each pixel. Both images linear RGB (Rec. 709), of one size, finite; values are clipped to [0,
/// 1].
Image<float> flip_error(const ColorImage& reference_linear, const ColorImage& test_linear,
                        double pixels_per_degree = flip_pixels_per_degree);

/// Returns the error of each pixel of grey images.
Image<float> flip_error(const Image<float>& reference_grey, const Image<float>& test_grey,
                        double pixels_per_degree = flip_pixels_per_degree);

/// The mean of errors; 0 of none.
double mean_flip(const Image<float>& error);
/// The mean of flip_error; 0 for empty images.
double mean_flip(const ColorImage& reference_linear, const ColorImage& test_linear,
                 double pixels_per_degree = flip_pixels_per_degree);

}  // namespace gnomon::compare
