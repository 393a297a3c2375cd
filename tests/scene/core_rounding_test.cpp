// The product's rounding to float is the processor's, component by component: no compiler option may keep a double's
// digits through a float (GCC 12 does where it joins neighbouring components to vectors, see cmake/GnomonTarget.cmake).
#include <gtest/gtest.h>

#include "scene/math.h"

namespace gnomon::test {

/// Each component rounded to float, compiled with the optimisation of the product instead of the tests' own
/// (support/through_float.cpp).
Vec3 through_float(const Vec3& v);

namespace {

// A volatile variable holds a float and nothing else.
double rounded(double v) {
  volatile auto f = static_cast<float>(v);
  return static_cast<double>(f);
}

TEST(Rounding, ThreeComponentsLoseWhatAFloatCannotHold) {
  const Vec3 v(0.46, 0.33, 0.2), through = through_float(v);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(through[i], rounded(v[i])) << i;
}

}  // namespace
}  // namespace gnomon::test
