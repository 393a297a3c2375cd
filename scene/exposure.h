// The one linear factor that takes radiance to what an 8-bit picture shows. One factor for both renderers'
// pictures, chosen from one of them: pictures that are exposed apart cannot be compared.
#pragma once

#include "scene/image.h"

namespace gnomon {

/// The share of the non-black pixels that auto_exposure leaves at or below auto_exposure_target.
inline constexpr double auto_exposure_percentile = 0.95;
/// Linear value, of 1, that the percentile is brought to.
inline constexpr double auto_exposure_target = 0.8;

/// The factor that brings the 95th percentile of the picture's luminance (Rec. 709; pixels that are black or
/// not finite do not count) to 0.8. A picture without any other pixel gets 1.
double auto_exposure(const ColorImage& linear);

}  // namespace gnomon
