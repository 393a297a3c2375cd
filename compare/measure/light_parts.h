// What a light's figures (measure/sums.h) are made of.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "compare/ladder/ladder.h"
#include "scene/image.h"

namespace gnomon::compare {

/// Widths of the texels that the compared pixels look up, world units; one of them where all are alike.
std::vector<double> texel_widths(const LadderInput& input, const Image<Label>& labels);
bool has_one_texel_size(const LightView& view);
/// Least, median and largest, which puts the values into another order; 0 of none.
std::array<double, 3> low_middle_high(std::vector<double>& values);

/// Some rows of a light's picture: white lit, black shadowed, white where nothing is compared. Where the truth is
/// uncertain the rungs have what is known of it, or are white both.
Image<float> visibility_picture(const Image<float>& visibility, const Image<Label>& labels,
                                const PictureRows& rows);

/// Mean over the pixels that are compared and have a value, in their order.
class ComparedMean {
 public:
  /// `map` begins at that row of the labels.
  void add(const Image<float>& map, const Image<Label>& labels, int first_row);
  double mean() const;  ///< NaN of none

 private:
  double sum_ = 0.0;
  std::uint64_t count_ = 0;
};

/// Collects the standard errors of partly lit compared pixels, in their order.
class StandardErrors {
 public:
  void add(const raytrace::LightTruth& truth, const Image<Label>& labels);
  void write_to(PenumbraStats& out) const;

 private:
  std::uint64_t count_ = 0;
  double sum_ = 0.0, max_ = 0.0;
};

/// A sentence, or nothing where a hard test drew, whose gaps say what every other constant bias would draw.
std::string_view why_no_curve(const raster::RasterFrame& drawn, const raster::LightRecord& record);

}  // namespace gnomon::compare
