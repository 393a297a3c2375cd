// Everything that is said of one light, summed up as the rows of its picture come, from the top. Sums go on from band to
// band in the order of the rows. So cutting a picture into bands changes no bit. Lists that grow long go to the disk,
// and what depends on neighbouring rows is measured as soon as these are there.
#pragma once

#include <optional>

#include "compare/bias/bias_kinds.h"
#include "compare/ladder/budget.h"
#include "compare/ladder/other_sizes.h"
#include "compare/ladder/penumbra.h"
#include "compare/measure/light_parts.h"
#include "compare/measure/number_list.h"
#include "compare/measure/pixel_measures.h"
#include "compare/measure/rows.h"
#include "compare/measure/weighted_light.h"
#include "compare/metrics/edges.h"
#include "compare/truth/theory.h"

namespace gnomon::compare {

struct MeasureOptions {
  int bias_curve_points = 129;
  /// FLIP and SSIM, which cost more than all the rest (NaN when left out), the maps of displacement, the kinds of bias,
  /// and maps of other sizes.
  bool perceptual = true;
  bool by_cascade = true;            ///< LightComparison::cascades
  const MapMeasures* map = nullptr;  ///< of the same map and the same compared pixels; null: made here
  Spill spill{};
};

/// FLIP and SSIM of the visibility pictures: white lit, black shadowed, white where nothing is compared.
class Perception {
 public:
  /// Rows of a picture of so many rows; those around them that are near by lie in `light`, whose row 0 is first_row.
  void add(const NearLight& light, int first_row, const PictureRows& rows, int height, MetricMaps& maps);
  void write_to(ErrorStats& out) const;

 private:
  double flip_sum_ = 0.0, ssim_sum_ = 0.0;
  std::uint64_t flips_ = 0, ssims_ = 0;
  ComparedMean flip_compared_, ssim_compared_;
};

class LightSums {
 public:
  LightSums(const MeasureOptions& options, const ImageSize& picture) : options_(options), picture_(picture) {}

  /// What each pixel of the next rows says by itself (`in.place` says where they lie). Gives the map of detachment.
  Expected<Image<float>> add_pixels(const LadderInput& in, const Climb& climb,
                                    const Image<Label>& labels_climbed);
  /// What pixels of the next rows say with their neighbours; as many as edge_margin rows around them lie in `near` and
  /// `light`.
  Expected<MetricMaps> add_neighbours(const LadderInput& near, const NearLight& light,
                                      const PictureRows& rows);
  /// All numbers; images stay as they are. `in`: its record has the map.
  Expected<void> finish(const LadderInput& in, LightComparison& out);

 private:
  Expected<void> add_widths(const LadderInput& in, const Image<Label>& labels);
  Expected<void> add_lists(const LadderInput& in, const Climb& climb);
  Expected<void> finish_theory();
  Expected<void> finish_curve(const LadderInput& in, LightComparison& out);

  MeasureOptions options_;
  ImageSize picture_;
  bool begun_ = false, soft_ = false, has_curve_ = false, has_kinds_ = false;
  PixelSums sums_;
  std::vector<CascadeSums> cascades_;
  std::uint64_t climbed_compared_ = 0;
  StandardErrors standard_errors_;
  DetachmentSum detachment_;
  PixelMeasures measures_;
  PenumbraMeasure penumbra_;
  std::optional<SeamCount> seams_;
  RayWork ray_work_;
  WeightedLight weighted_;
  OtherSizesSum other_sizes_;
  EdgeSums edges_;
  Perception perception_;
  NumberList<double> texel_widths_;  ///< one where all are alike
  std::array<NumberList<double>, std::tuple_size_v<TheoryValues>> theory_;
  MapMeasures map_;
  std::array<NumberList<float>, 2> gaps_;  ///< of shadowed and of lit pixels
  std::uint64_t ties_ = 0;                 ///< in neither (GapLists)
  std::array<std::array<NumberList<float>, side_count>, kind_count> kinds_;
  std::array<std::uint64_t, kind_count> kinds_left_out_{};
};

}  // namespace gnomon::compare
