// What is summed pixel by pixel, rows of a picture after rows, from the top. A measure is a class with two functions, and a
// name in PixelMeasures: `void add(const LadderInput&, const Climb&)` takes the next rows, `void write_to(LightFigures&) const`
// says what they came to. Its figures are rows of result/figure_rows.cpp; result.json, its schema, the CSV files and the
// pages' tables follow from those.
#pragma once

#include <optional>
#include <tuple>

#include "compare/ladder/filter_probe.h"
#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// Counts the compared pixels that lie outside the map.
class OutsideSum {
 public:
  void add(const LadderInput& in, const Climb& climb);
  void write_to(LightFigures& out) const { out.outside = sum_; }

 private:
  OutsideMap sum_;
};

/// Counts what the compared pixels looked up (LightRecord::lookups).
class LookupSum {
 public:
  void add(const LadderInput& in, const Climb& climb);
  void write_to(LightFigures& out) const { out.lookups = sum_; }

 private:
  std::optional<std::uint64_t> sum_;
};

using PixelMeasures = std::tuple<BleedingSum, OutsideSum, LookupSum>;

}  // namespace gnomon::compare
