// Both shadows at several places within each pixel: what a pixel's centre leaves out, on silhouettes too, is bounded by that.
#pragma once

#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

/// Takes a finer picture of the same view, of `side` x `side` pixels for each of the picture's, and adds it up by pixel.
class SubpixelSums {
 public:
  SubpixelSums(ImageSize picture, int side, std::size_t lights);

  int side() const { return side_; }
  /// Rows of the finer picture, from its row `first_row` on; each comes once.
  void add(std::size_t light, int first_row, const Climb& climb);
  SubpixelFigures figures(std::size_t light) const;

 private:
  struct Sums {
    Image<float> difference;  ///< of V6 - V0 over the places that are known
    Image<std::uint8_t> known, unknown;
  };
  int side_;
  std::vector<Sums> lights_;
};

}  // namespace gnomon::compare
