// How wide the soft shadows of a light with size are, in truth and as drawn.
#pragma once

#include <optional>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/metrics/image_rows.h"

namespace gnomon::compare {

inline constexpr int penumbra_margin = 1032;  ///< rows above and below a row on which its widths depend
inline constexpr int penumbra_rows_kept = 2 * penumbra_margin + most_spare_rows;

/// Starts at every pair of neighbouring pixels of one object between which the truth crosses one half. Walks
/// in the picture both ways, straight across the edge as it lies on the receiver (the truth's gradient over a
/// 7x7 window). On the drawn shadow it walks from its own crossing nearest to there. The penumbra is the way
/// from a tenth to nine tenths visible, the umbra the way below a tenth beyond it. Both are in world units on
/// the receiver. Visibility and receivers are taken between pixel centres, so that a width is not rounded to
/// whole pixels; of an edge that is sharper than a pixel it is still 0.8 pixel. `labels`: labels_climbed(). A
/// picture comes in parts, each of whole rows, from the top. Keeps 36 bytes a pixel of at most
/// penumbra_rows_kept rows and of what was added last.
class PenumbraMeasure {
 public:
  /// The rows under those that were added before: input.place says where they lie.
  void add(const LadderInput& input, const Image<float>& truth, const Image<Label>& labels);
  PenumbraStats stats() const;

 private:
  /// What a walk asks of a pixel.
  struct Pixels {
    Image<Vec3> positions;
    Image<std::uint32_t> objects;  ///< no_id where nothing is measured
    Image<float> truth, drawn;
  };
  struct Width {
    std::optional<double> penumbra, umbra;  // world units; none where a walk left the object or the picture
  };
  struct Sample {
    Width truth, drawn;
  };
  class Walker;
  static Pixels pixels_of(const LadderInput& input, const Image<float>& truth, const Image<Label>& labels);
  static void add_widths(const std::vector<Sample>& samples, PenumbraStats& out);
  void keep(Pixels&& rows, int height);
  void count(const Pixels& rows);
  void measure(const PictureRows& rows);
  void forget_above(int row);

  Pixels pixels_;
  int first_ = 0;     ///< of the picture: row 0 of pixels_
  int measured_ = 0;  ///< rows of the picture
  std::vector<Sample> samples_;
  PenumbraStats counts_;
};

}  // namespace gnomon::compare
