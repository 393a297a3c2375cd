// A ray owns its interval. The direction need not be unit length: t is in multiples of it.
#pragma once

#include "scene/math.h"

namespace gnomon {

struct Ray {
  Vec3 origin;
  Vec3 direction;
  Interval t{0.0, infinity};

  Vec3 at(double s) const { return origin + s * direction; }
};

}  // namespace gnomon
