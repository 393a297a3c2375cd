// What maps of other sizes would leave, estimated by rays. Some pixels spread over the picture are tested, with the bias
// and the filter of the drawing. They are tested against the exact depths at the texel centres of such a map, rounded as
// its format stores them. Nothing is drawn for it, so that its time depends on neither triangles nor texels.
#pragma once

#include <vector>

#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// Whether a hard or averaged test of the nearest depths drew the light. Its answer follows from the texels' centres. So
/// there is no shader of the user's own, no culling, no bias of casters, no blended cascades, and no filter whose taps are
/// chosen by pixel.
bool other_sizes_apply(const raster::RasterFrame& drawn, const raster::LightRecord& record);

/// What a map of `size` texels a side, laid as the drawn one, would give a pixel's receiver: V6 in [0, 1]. Depths are
/// exact up to the format's step; the face is the one that the drawing looked up.
class OtherSize {
 public:
  OtherSize(const LadderInput& input, int size);
  float visibility(std::size_t pixel) const;

 private:
  struct Receiver;
  bool is_lit(const Receiver& receiver, int column, int row) const;

  const LadderInput& in_;
  raster::LightRecord record_;  ///< the drawn one without its images, of the other size
};

/// Sums over the rows of a picture, from the top, the same however it is cut.
class OtherSizesSum {
 public:
  /// `in.place` says where the rows lie in a picture of so many pixels.
  void add(const LadderInput& in, const Image<float>& truth, const Image<Label>& labels,
           std::size_t all_pixels);
  /// `drawn_error`: ErrorStats::mean_absolute of the whole picture.
  std::vector<OtherMapSize> figures(double drawn_error) const;

 private:
  struct Size {
    int size = 0;
    double sum = 0.0, squares = 0.0;  ///< of |V6' - V0| - |V6 - V0|
  };
  std::vector<Size> sizes_;
  std::uint64_t count_ = 0;
};

}  // namespace gnomon::compare
