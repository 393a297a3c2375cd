// What a case works with: the tracer under test, and the loop that spreads trials over all threads in blocks
// whose results do not depend on which thread took them.
#pragma once

#include <algorithm>
#include <bit>

#include "raytrace/tracer.h"
#include "verify/small_world.h"
#include "verify/verify.h"

namespace gnomon::verify {

/// What one block of trials found; sums and maxima, so that the order of blocks does not matter.
struct Tally {
  std::uint64_t tried = 0, wrong = 0;
  double worst = 0.0;
  void check(bool right) { ++tried, wrong += right ? 0 : 1; }
  /// NaN counts as infinite.
  void error(double size) { worst = size <= worst ? worst : (size >= 0.0 ? size : infinity); }
};

class Run {
 public:
  Run(int number, const Options& options, bool textbook, const Progress& progress)
      : number_(number), options_(options), textbook_(textbook), progress_(progress) {}

  raytrace::Tracer tracer(const World& world, raytrace::Accel accel = raytrace::Accel::bvh) const {
    return raytrace::Tracer(world, accel, precision());
  }
  raytrace::Precision precision() const { return textbook_ ? raytrace::Precision::fast : options_.precision; }
  /// The naive formulation is under test, also of what all precisions share.
  bool is_textbook() const { return textbook_; }
  /// Share of --rays, at least 256 of them and never above `most`, which may be fewer.
  std::uint64_t rays(double share = 1.0, std::uint64_t most = ~std::uint64_t{0}) const;
  std::uint64_t seed() const { return options_.seed; }

  /// One row: trial(random, tally) so many times. unit and bound as in Row.
  template <class Trial>
  void sample(const std::string& name, std::uint64_t trials, const Trial& trial, const std::string& unit = {},
              double bound = 0.0) {
    blocks({.number = number_, .name = name, .unit = unit, .bound = bound, .outcome = {}, .naive = {}},
           trials, [&](Random& random, std::uint64_t count, Tally& tally) {
             for (std::uint64_t i = 0; i < count; ++i) trial(random, tally);
           });
  }

  /// One row: check(index, tally) for every index below `count`; for what was computed beforehand.
  template <class Check>
  void sample_each(std::string name, std::uint64_t count, const Check& check, std::string unit = {},
                   double bound = 0.0) {
    Tally tally;
    for (std::uint64_t i = 0; i < count; ++i) check(i, tally);
    rows_.push_back({.number = number_,
                     .name = std::move(name),
                     .unit = std::move(unit),
                     .bound = bound,
                     .outcome = {tally.tried, tally.wrong, tally.worst},
                     .naive = {}});
  }

  /// One row that this machine cannot run, and why: nothing is wrong with it.
  void skip(std::string name, std::string why) {
    rows_.push_back({.number = number_,
                     .name = std::move(name),
                     .unit = {},
                     .outcome = {},
                     .naive = {},
                     .skipped = std::move(why)});
  }

  /// One row of what could not be tried on a machine that has all it takes: one trial, and a wrong one.
  void fault(const std::string& name, const std::string& why) {
    sample_each(name + ": " + why, 1, [](std::uint64_t, Tally& tally) { tally.check(false); });
  }

  std::vector<Row> take_rows() { return std::move(rows_); }

 private:
  using Block = std::function<void(Random&, std::uint64_t, Tally&)>;
  void blocks(Row row, std::uint64_t trials, const Block& block);

  int number_;
  Options options_;
  bool textbook_;
  const Progress& progress_;
  std::vector<Row> rows_;
};

}  // namespace gnomon::verify
