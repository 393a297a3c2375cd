// Seeded random numbers for trials and for the small scenes: a failure repeats itself on every machine.
#pragma once

#include "scene/generate/random.h"

namespace gnomon::verify {

/// SplitMix64, the generators' own bits, with what aimed rays need. Any two seeds give unrelated sequences.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::uint64_t next() { return bits_.bits(); }
  double uniform(double lo, double hi) { return bits_.between(lo, hi); }
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
  gnomon::Random bits_;
};

}  // namespace gnomon::verify
