// The axes of a sweep: which values an option runs through, and which cells they make. Values are texts, as
// the command line takes them; what they mean is the business of whoever reads the option.
//   list          128,512,2048          pcf,hard         0.5texel,1texel
//   linear range  START:END:COUNT       0:0.1:64         0:4texel:9       COUNT values, both ends among them
//   ×-range       START:END:xFACTOR     128:8192:x2      START, START·FACTOR, … up to END
// Values with commas of their own (AZIMUTH,ELEVATION) are listed with '/' between them, and their ranges run
// through every component at once: 0,30:360,30:12 is a path around the scene.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::studies {

struct Axis {
  std::string name;  ///< of the option, without "--"
  std::vector<std::string> values;
};

inline constexpr std::size_t max_axis_values = 100000;
inline constexpr std::size_t max_cells = 1000000;

enum class ValueKind : std::uint8_t {
  number,   ///< lists and ranges
  numbers,  ///< several numbers with commas between them: lists with '/', ranges
  word      ///< lists only: a ':' is part of the word
};

/// The values that a text names. Numbers inside a range are rounded to twelve digits, its ends are as given;
/// their text is the shortest that reads back as the same number. Errors are ErrorKind::usage.
Expected<std::vector<std::string>> expand_values(std::string_view text, ValueKind kind = ValueKind::number);

/// The product of the axes, the last one running fastest; or, zipped, the first values of all axes, the
/// second values of all axes, and so on (axes of one value stay as they are).
class Grid {
 public:
  static Expected<Grid> make(std::vector<Axis> axes, bool zip);
  const std::vector<Axis>& axes() const { return axes_; }
  bool zipped() const { return zip_; }
  std::size_t cells() const { return cells_; }
  /// Which value of each axis a cell has.
  std::vector<std::size_t> position(std::size_t cell) const;
  const std::string& value(std::size_t axis, std::size_t cell) const {
    return axes_[axis].values[position(cell)[axis]];
  }

 private:
  std::vector<Axis> axes_;
  bool zip_ = false;
  std::size_t cells_ = 1;
};

}  // namespace gnomon::studies
