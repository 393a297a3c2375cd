// How another renderer may average its comparisons around a place of its map. A capture says how far a filter reaches; which
// of these it is the picture tells.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/math.h"

namespace gnomon::judge {

struct FilterKernel {
  enum class Shape : std::uint8_t {
    one,          ///< the place's own texel
    taps,         ///< `side` x `side` texels, each `spacing` texels from the next
    linear_taps,  ///< the same, each the linear filter of the four texels around it
    tent,         ///< weights fall linearly to 0 at `radius` along both axes
    disc,         ///< all places within `radius` alike: what taps strewn over a disc come to on average
  };
  Shape shape = Shape::one;
  int side = 1;
  double spacing = 1.0, radius = 0.0;  ///< texels
  double rim_radius = 0.0,
         rim_share = 0.0;  ///< so much of the weight lies on a circle about the place, texels

  /// Returns how far from the place along an axis a texel can lie that is read.
  int reach() const;
  /// Returns how far from the place the filter itself reaches, texels.
  double half_width() const;
  int width() const { return 2 * reach() + 1; }  ///< texels, the place's own in the middle
  /// Returns how far a tap, of `side` along an axis, lies from the place, texels.
  double tap_offset(int k) const { return (k - 0.5 * (side - 1)) * spacing; }
  /// Sets the weights of the texels around a place, row by row, which add up to 1. `within`: the place in its own texel, in
  /// [0, 1) along both axes.
  void weigh(const Vec2& within, std::vector<double>& weights) const;

 private:
  void weigh_shape(const Vec2& within, std::vector<double>& weights) const;
};

/// Returns the kernels to be tried of a filter that is said to reach so far, the usual ones first.
std::vector<FilterKernel> kernels_of_reach(double radius_texels);

}  // namespace gnomon::judge
