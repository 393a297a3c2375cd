// How wide the soft shadows of a light with size are, in truth and as drawn.
#pragma once

#include <optional>
#include <vector>

#include "compare/ladder.h"
#include "scene/picture_rows.h"

namespace gnomon::compare {

/// At every pair of neighbouring pixels of one object between which the truth crosses one half, walks in the
/// picture straight across the edge as it lies on the receiver (the truth's gradient over a 7x7 window) both
/// ways, on the drawn shadow from its own crossing nearest to there: the penumbra is the way from a tenth to
/// nine tenths visible, the umbra the way below a tenth beyond it, both in world units on the receiver.
/// Visibility and receivers are taken between pixel centres, so that a width is not rounded to whole pixels;
/// of an edge that is sharper than a pixel it is still 0.8 pixel. `labels`: labels_climbed().
PenumbraStats measure_penumbra(const LadderInput& input, const Image<float>& truth,
                               const Image<Label>& labels);

inline constexpr int penumbra_margin = 1032;  ///< rows above and below a row on which its widths hang

/// The same of a picture that comes in parts, each of whole rows, from the top.
class PenumbraMeasure {
 public:
  /// Those rows of the images, row 0 of which is first_row of the picture; all within penumbra_margin of them must
  /// be there.
  void add(const LadderInput& input, const Image<float>& truth, const Image<Label>& labels, int first_row,
           const PictureRows& rows);
  PenumbraStats stats() const;

 private:
  struct Width {
    std::optional<double> penumbra, umbra;  // world units; none where a walk left the object or the picture
  };
  struct Sample {
    Width truth, drawn;
  };
  class Walker;
  static void add_widths(const std::vector<Sample>& samples, PenumbraStats& out);
  std::vector<Sample> samples_;
  PenumbraStats counts_;
};

}  // namespace gnomon::compare
