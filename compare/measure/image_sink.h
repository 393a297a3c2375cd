// Where the images of a picture go while it is measured: into the comparison, or of a picture in bands to the disk.
#pragma once

#include <memory>

#include "compare/measure/measure.h"

namespace gnomon::compare {

class ImageSink {
 public:
  virtual ~ImageSink() = default;
  /// Maps of the rows that follow those of the last call; rows.count may be 0.
  virtual Expected<void> keep_maps(std::size_t light, FinishedMaps&& maps, const PictureRows& rows) = 0;
  /// One light's rows of a band, as `in` has them.
  virtual Expected<void> keep_light(const LadderInput& in, Climb&& climb, Image<float>&& detached,
                                    const PictureRows& rows) = 0;
  /// The band itself, after its lights.
  virtual Expected<void> keep_frames(Frames&& band, const PictureRows& rows) = 0;
  /// What both pictures are shown with; after the last band.
  virtual Expected<double> exposure() = 0;
};

/// `parts`: of a picture in bands; null: the images stay in `out`.
std::unique_ptr<ImageSink> make_sink(Comparison& out, const Plan& plan, BandedParts* parts);

}  // namespace gnomon::compare
