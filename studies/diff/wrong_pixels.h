// Which pixels a result got wrong, and why, as its folder keeps them. labels.png has each error on the line between grey and its
// label's colour, as far along as it is large; error.png says how large it is. No two lines have a colour in common beyond their
// middles (diff_pixels_test), so that both together are a record.
#pragma once

#include <string>

#include "compare/comparison.h"
#include "scene/base/expected.h"
#include "scene/image.h"

namespace gnomon::studies {

/// Where a result's folder has them.
struct PixelFiles {
  std::string labels, error;
};

/// The label of each wrong pixel; Label::right of those that err by one half and less, and what the others are. A pixel within
/// 0.002 of one half may be on either side.
Expected<Image<compare::Label>> read_wrong_pixels(const PixelFiles& files);

}  // namespace gnomon::studies
