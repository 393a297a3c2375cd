// What a case works with: seeded random numbers, the tracer under test, and the loop that spreads trials over
// all threads in blocks whose results do not depend on which thread took them.
#pragma once

#include <algorithm>
#include <bit>

#include "app/verify/verify.h"
#include "raytrace/tracer.h"

namespace gnomon::verify {

/// SplitMix64 (Steele, Lea, Flood 2014): small, and any two seeds give unrelated sequences.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((next() >> 32) * n >> 32); }
  int integer(int lo, int hi) {
    return lo + static_cast<int>(below(static_cast<std::uint32_t>(hi - lo + 1)));
  }
  bool coin() { return (next() >> 63) != 0; }
  double power_of_ten(double lo, double hi) { return std::pow(10.0, uniform(lo, hi)); }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction();
  /// Moved by up to `steps` representable numbers per component.
  Vec3 nudged(const Vec3& p, int steps);

 private:
  std::uint64_t state_;
};

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
  /// Share of --rays, at least one block and never above `most`.
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

  /// One row that could not be run, and why.
  void skip(std::string name, std::string why) {
    rows_.push_back({.number = number_,
                     .name = std::move(name),
                     .unit = {},
                     .outcome = {},
                     .naive = {},
                     .skipped = std::move(why)});
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
