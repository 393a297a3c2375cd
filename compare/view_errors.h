// What a setting errs by from several views, and where in the scene: plain data, which result/views.h and result/places.h make.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/result/threshold.h"
#include "scene/math.h"

namespace gnomon::compare {

/// Where errors lie as seen from above, over pixels, lights and views (result/places.h): squares in rows, the first at the
/// least x and z.
struct ErrorPlaces {
  struct Cell {
    std::uint64_t pixels = 0;
    double error = 0.0;  ///< sum of |V6 - V0|
  };
  Vec2 corner{0.0};   ///< least x and z, world units
  double side = 0.0;  ///< of a square, world units
  int columns = 0, rows = 0;
  std::vector<Cell> cells{};  ///< empty: not counted
  Cell beyond{};              ///< what lies outside all squares
};

/// What a setting errs by from each of several views; the comparison that holds this is that of the worst.
struct ViewErrors {
  struct OfView {
    std::string name, light;  ///< the light that errs most there
    double error = 0.0;       ///< of that light, in the measure's unit; NaN where nothing is compared
    Vec3 eye{}, direction{};  ///< where the camera stands and looks, the direction of length 1
  };
  const Figure* measure = &wrong_and_mean();
  std::vector<OfView> views{};  ///< none: a single picture was judged
  std::size_t worst = 0;        ///< index of the view that errs most
  ErrorPlaces places{};
};

}  // namespace gnomon::compare
