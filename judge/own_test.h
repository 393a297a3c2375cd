// What the test that a capture describes makes of its picture, before any convention is suspected. A renderer's own map,
// matrix and bias may draw what the picture shows. Then it has no convention wrong, however little its shadows have to do
// with the truth.
#pragma once

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// Samples inside the map, and on how many of them the test is the picture.
struct OwnTestCount {
  std::size_t pixels = 0, as_drawn = 0;
  std::size_t dark = 0;        ///< by the test
  std::size_t drawn_dark = 0;  ///< by the picture

  /// The test is the picture in 19 of 20 samples, and what differs is the smaller part of what either shadows.
  bool is_believed() const;
};

struct OwnTest {
  OwnTestCount clear;  ///< the filter reads texels that all agree
  OwnTestCount all;    ///< where they do not, the picture has to come near to their mean
  /// What the picture shows where the test is dark, where most of that is one value; else 0.
  double full_shadow = 0.0;
  /// The same of the whole picture within the map, whatever the test is.
  double darkest = 0.0;

  bool is_believed() const { return clear.is_believed() || all.is_believed(); }
};

/// `drawn`: the capture's frame. Darker than halfway between `full_shadow` and 1 counts as shadow.
OwnTest try_own_test(const FrameInput& input, const raster::RasterFrame& drawn);

/// That no shadow is drawn, and why, as a sentence; `drawn` shows none where the truth has some.
std::vector<std::string> no_shadow_notes(const compare::LightComparison& light,
                                         const raster::LightRecord& record);

/// The visibility with what is drawn as `full_shadow` in [0, 1) as 0.
void stretch_to_full_shadow(double full_shadow, Image<float>& visibility);

}  // namespace gnomon::judge
