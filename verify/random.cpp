#include "verify/random.h"

namespace gnomon::verify {

Vec3 Random::direction() {
  for (;;) {
    const Vec3 d = in_box(1.0);
    const double length = glm::length(d);
    if (length > 0.1 && length <= 1.0) return d / length;
  }
}

Vec3 Random::nudged(const Vec3& p, int steps) {
  Vec3 moved = p;
  for (int a = 0; a < 3; ++a) {
    const int n = integer(-steps, steps);
    for (int i = 0; i < std::abs(n); ++i) moved[a] = std::nextafter(moved[a], n < 0 ? -infinity : infinity);
  }
  return moved;
}

}  // namespace gnomon::verify
