// The percentile is a pixel's own value (nearest rank), so that it is the same for any number of threads and
// any order.
#include "scene/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gnomon {

double auto_exposure(const ColorImage& linear) {
  const Vec3f weights(0.2126f, 0.7152f, 0.0722f);  // ITU-R BT.709-6, item 3.2
  std::vector<float> luminance;
  luminance.reserve(linear.data.size());
  for (const Vec3f& pixel : linear.data) {
    const float value = glm::dot(weights, pixel);
    if (std::isfinite(value) && value > 0.0f) luminance.push_back(value);
  }
  if (luminance.empty()) return 1.0;

  const double count = static_cast<double>(luminance.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(auto_exposure_percentile * count)) - 1;
  const auto chosen = luminance.begin() + std::max<std::ptrdiff_t>(rank, 0);
  std::nth_element(luminance.begin(), chosen, luminance.end());
  return auto_exposure_target / static_cast<double>(*chosen);
}

}  // namespace gnomon
