// Maps of moments as they would have been stored with other exponents. What the light meets first at each texel is warped
// with them and averaged as the renderer averages.
#pragma once

#include <vector>

#include "judge/captured_frame.h"

namespace gnomon::compare {

class MomentMaps {
 public:
  /// Traces a ray for each texel. The record reads moments; both must outlive this.
  MomentMaps(const FrameInput& input, const raster::LightRecord& record);

  /// Tells whether the averages so made are those that are stored, but for a tenth of what averaging changes.
  bool are_as_stored() const { return as_stored_; }
  /// Returns the texels with the exponents of `moments`, which has the record's technique.
  std::vector<raster::CapturedMoments::Texel> texels(const raster::CapturedMoments& moments) const;

 private:
  std::vector<double> averaged(const std::vector<double>& values, int reach) const;
  void fit_reach();

  const raster::LightRecord& record_;
  std::vector<double> numbers_;  ///< by texel, as they are stored; 1 where nothing is met
  int reach_ = 0;                ///< texels to each side that are averaged
  bool as_stored_ = false;
};

/// Exponents that people set: of the positive warp, and of the negative one (0: none).
struct WarpExponents {
  double positive = 0.0, negative = 0.0;
};
std::vector<WarpExponents> exponents_to_try(const raster::CapturedMoments& moments);

}  // namespace gnomon::compare
