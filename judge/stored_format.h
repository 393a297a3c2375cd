// How precise the numbers of a captured map are: told by what they have in common, since no capture says it.
#pragma once

#include <string>
#include <vector>

namespace gnomon::judge {

/// What numbers have in common.
struct StoredFormat {
  double step = 0x1p-24;  ///< the smallest difference of two of them; of floating ones between 1/2 and 1
  bool floating = true;   ///< the step halves where the number does
};

/// Returns the coarsest of the usual formats that holds all numbers; that of floats where few differ, which tell nothing.
StoredFormat find_format(std::vector<float> numbers);

/// Returns the smallest difference of the format's numbers near one of them.
double step_near(const StoredFormat& format, double number);

/// "the map's depths are multiples of 1/255: eight bits, steps of 0.03 world units"; nothing of floats and what is hardly
/// coarser. `unit_world`: world units in 1 of the numbers; 0: not the same everywhere.
std::vector<std::string> format_notes(const StoredFormat& format, double unit_world);

}  // namespace gnomon::judge
