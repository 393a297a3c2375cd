// Everything that is said of one light (light_comparison.h) of a picture that comes in bands, to the last bit as if it
// came whole: sums go on from band to band in the order of the rows, long lists wait on the disk, and what hangs on
// neighbouring rows is measured as soon as these are there.
#pragma once

#include "compare/bands/near_rows.h"
#include "compare/bands/number_file.h"
#include "compare/bias_kinds.h"
#include "compare/bleeding.h"
#include "compare/by_cascade.h"
#include "compare/edges.h"
#include "compare/light_parts.h"
#include "compare/penumbra.h"
#include "compare/theory.h"

namespace gnomon::compare {

/// A picture in bands, as a light's measures see it.
struct BandPlace {
  ImageSize picture;
  PictureRows rows;  ///< of the picture, that come next
};

/// Maps of the rows that were finished.
struct FinishedMaps {
  Image<float> edges, flip, ssim;
};

class LightMeasures {
 public:
  LightMeasures(std::string folder, int curve_points, bool perceptual)
      : folder_(std::move(folder)), curve_points_(curve_points), perceptual_(perceptual) {}

  /// What each pixel says by itself. Gives the map of detachment.
  Expected<Image<float>> add_pixels(const LadderInput& in, const Climb& climbed,
                                    const Image<Label>& labels_climbed, const BandPlace& place);
  /// What pixels say with their neighbours; place.rows and edge_margin rows around them lie in the window.
  Expected<FinishedMaps> add_neighbours(const LadderInput& near, const NearLight& light, int first_row,
                                        const BandPlace& place);
  /// `in`: its record has the map and is without images.
  Expected<LightComparison> finish(const LadderInput& in, std::size_t record);
  std::vector<CascadeFigures> cascades() const { return figures_of(cascades_); }

 private:
  void add_perception(const NearLight& light, int first_row, const BandPlace& place, FinishedMaps& maps);
  Expected<void> add_lists(const LadderInput& in, const Climb& climbed);
  Expected<void> finish_lists(const LadderInput& in, LightComparison& out);
  Expected<void> finish_curve(const LadderInput& in, LightComparison& out);

  std::string folder_;
  int curve_points_;
  bool perceptual_;
  bool begun_ = false, soft_ = false, has_curve_ = false, has_kinds_ = false;
  PixelSums sums_;
  std::vector<CascadeSums> cascades_;
  std::uint64_t climbed_compared_ = 0;
  StandardErrors standard_errors_;
  DetachmentSum detachment_;
  BleedingSum bleeding_;
  PenumbraMeasure penumbra_;
  std::optional<SeamCount> seams_;
  std::optional<std::uint64_t> lookups_;
  RayWork ray_work_;
  EdgeSums edges_;
  double flip_sum_ = 0.0, ssim_sum_ = 0.0;
  std::uint64_t flips_ = 0, ssims_ = 0;
  ComparedMean flip_compared_, ssim_compared_;
  std::vector<double> texel_width_;  ///< where all are alike
  NumberFile<double> texel_widths_;
  std::array<NumberFile<double>, std::tuple_size_v<TheoryValues>> theory_;
  std::array<NumberFile<float>, 2> gaps_;  ///< of shadowed and of lit pixels
  std::uint64_t ties_ = 0;                 ///< in neither (GapLists)
  std::array<std::array<NumberFile<float>, 2>, kind_count> kinds_;
  std::array<std::uint64_t, kind_count> kinds_left_out_{};
};

}  // namespace gnomon::compare
