// Counting pixels and adding up steps. Every sum is taken row by row and then over the rows in order, so that
// it is the same for any number of threads; for a hard test all terms are integers and the sums are exact.
#pragma once

#include <vector>

#include "compare/comparison.h"
#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// The share of wrong pixels. Two pixels that are off by exactly one half (ties) count as one wrong pixel; 0 of no
/// pixels.
double wrong_share(std::uint64_t wrong, std::uint64_t ties, std::uint64_t pixels);

/// For words: `sum`, or 0 where it is no more than what rounding leaves of it. `sizes`: what its terms add up to without
/// their signs.
double beyond_rounding(double sum, double sizes);

/// A pixel that the sampling step made wrong and that is drawn right.
bool is_accident(const std::array<float, rung_count>& rungs);

/// What compared pixels add up to. Where all rungs are 0 or 1 every sum is a whole number, and exact in any order.
class PixelTerms {
 public:
  /// A compared pixel, `times` over; -1 takes away one that was added.
  void add(const std::array<float, rung_count>& rungs, Label label, double times = 1.0);
  void add(const PixelTerms& other);

  /// wrong, false and missed shadow, ties, fractional, mean |V6 - V0| and RMS; FLIP and SSIM are NaN.
  ErrorStats error() const;
  std::array<std::uint64_t, class_count> classes() const;
  std::array<double, class_count> class_errors() const;  ///< means over the compared pixels
  RightByAccident accidents() const;
  /// Mean visibility of each rung; 0 of no pixels.
  std::array<double, rung_count> rung_means() const;
  /// Means of the steps, and the wrong pixels that each is to blame for.
  Budget budget() const;
  /// All of these; FLIP and SSIM of the light become NaN.
  void write_to(LightComparison& light) const;

 private:
  struct Step {
    double signed_sum = 0.0, absolute_sum = 0.0, false_shadow = 0.0, missed_shadow = 0.0;
  };
  double compared_ = 0.0, false_shadow_ = 0.0, missed_shadow_ = 0.0, ties_ = 0.0, fractional_ = 0.0;
  double absolute_ = 0.0, squared_ = 0.0;
  std::array<double, rung_count> rungs_{};
  std::array<double, 2> accidents_{};
  std::array<double, class_count> classes_{}, class_errors_{};
  std::array<Step, cause_count + 1> steps_{};
};

/// The sums of a picture that comes in parts, each of whole rows, from the top: the same as those of the whole.
class PixelSums {
 public:
  void add(const std::array<Image<float>, rung_count>& rungs, const Image<Label>& labels);
  /// V0 and V6 alone; of the terms error() says something then.
  void add_ends(const Image<float>& truth, const Image<float>& drawn, const Image<Label>& labels);
  PixelCounts pixels() const;
  const PixelTerms& terms() const { return terms_; }

 private:
  template <class RungsOf>
  void add_rows(const Image<Label>& labels, const RungsOf& rungs_of);

  std::array<std::uint64_t, 256> labels_{};  ///< pixels by label
  PixelTerms terms_;
};

PixelCounts count_pixels(const Image<Label>& labels);

// The figures of each cascade by itself: of its compared pixels alone.

/// One cascade's pixels, part by part from the top.
struct CascadeSums {
  explicit CascadeSums(int of_face) : face(of_face) {}
  void add(const raster::LightRecord& record, const std::array<Image<float>, rung_count>& rungs,
           const Image<Label>& labels);
  int face;
  PixelSums sums{};
};

/// One for each cascade of a map of technique csm that was drawn here; else none.
std::vector<CascadeSums> sums_of_cascades(const raster::RasterFrame& drawn,
                                          const raster::LightRecord& record);
std::vector<CascadeFigures> cascade_figures(const std::vector<CascadeSums>& sums);

}  // namespace gnomon::compare
