// Usual mistakes in the description of a shadow test, and what each would change in the record of its map.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

struct TestSuspect {
  std::string of_capture;   ///< what is wrong where the test so changed is the better one
  std::string of_renderer;  ///< empty: the capture is wrong in any case
  std::function<bool(raster::LightRecord&)> change;  ///< false: does not apply
  bool by_fronts = false;  ///< offsets go along the front's normal, also where the back is seen
  bool swapped = false;    ///< what the test would darken is lit, and the reverse
  double of_slope = 1.0;   ///< the slope bias, times the described one
  bool turns_map = false;  ///< all of it is read another way
  bool of_sign = false;    ///< the most usual kind, of which a picture that is all dark tells, too
  bool of_constant = false;
  bool with_others = false;  ///< may come together with another such mistake
};

/// `described`: the record as the capture says it; `light`: what was drawn on it. Places and numbers that a mistake leaves
/// open (where shadows end, a layer's constant) are those with which the picture agrees best.
std::vector<TestSuspect> test_suspects(const FrameInput& input, const raster::LightRecord& described,
                                       const compare::LightComparison& light);

}  // namespace gnomon::judge
