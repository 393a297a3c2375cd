// When another setting is worth a sentence: one rule for every "Try" and "instead of", of Gnomon's own drawings and of
// captures.
#pragma once

#include <cstdint>

namespace gnomon::compare {

struct Figure;
struct LightFigures;

/// Is what a drawing leaves wrong, over all compared pixels.
struct Left {
  double wrong_fraction = 0.0;  ///< as ErrorStats has it
  double mean_absolute = 0.0;   ///< as ErrorStats has it
  double measured = 0.0;        ///< by the measure in use; NaN: not known
};
Left left_by(const LightFigures& drawn, const Figure& measure);

/// Tells whether a setting that was drawn or evaluated is to be advised. It must be worse neither in the share of wrong pixels
/// nor in the mean error. By the measure in use it must leave clearly less. Clearly is a twentieth less, which two digits show.
/// Of `compared` pixels the gain must also be more than twice the square root of those wrong now. By so many a count changes
/// where pixels happen to lie elsewhere. The best of many settings gains as much by that alone.
bool is_worth_advising(const Left& instead, const Left& now, std::uint64_t compared);

}  // namespace gnomon::compare
