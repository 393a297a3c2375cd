// The one linear factor that takes radiance to what an 8-bit picture shows. One factor for both renderers'
// pictures, chosen from one of them: pictures that are exposed apart cannot be compared.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/image.h"

namespace gnomon {

/// The share of the non-black pixels that auto_exposure leaves at or below auto_exposure_target.
inline constexpr double auto_exposure_percentile = 0.95;
/// Linear value, of 1, that the percentile is brought to.
inline constexpr double auto_exposure_target = 0.8;

/// The factor that brings the 95th percentile of the picture's luminance (Rec. 709; pixels that are black or
/// not finite do not count) to 0.8. A picture without any other pixel gets 1.
double auto_exposure(const ColorImage& linear);

/// Finds the exposure of a picture that comes in parts: all of them by count(), then all of them again by collect().
class AutoExposure {
 public:
  AutoExposure();
  void count(std::span<const Vec3f> linear);
  /// After the last count(); false: no pixel counts, and there is nothing to collect.
  bool choose();
  void collect(std::span<const Vec3f> linear);
  double factor();

 private:
  std::vector<std::uint32_t> counts_;  ///< by class of luminance
  std::size_t chosen_ = 0;
  std::uint64_t rank_ = 0;              ///< of the percentile in its class
  std::vector<std::uint32_t> members_;  ///< of the class, as the bits of floats
};

}  // namespace gnomon
