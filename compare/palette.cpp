#include "compare/palette.h"

#include <array>
#include <cmath>

namespace gnomon::compare {

glm::u8vec3 viridis(double t) {
  // Every sixteenth entry of matplotlib's table of 256, the last one included; between them linear in sRGB.
  static constexpr std::array<glm::u8vec3, 17> table{{{68, 1, 84},
                                                      {72, 26, 108},
                                                      {71, 47, 125},
                                                      {65, 68, 135},
                                                      {57, 86, 140},
                                                      {49, 104, 142},
                                                      {42, 120, 142},
                                                      {35, 136, 142},
                                                      {31, 152, 139},
                                                      {34, 168, 132},
                                                      {53, 183, 121},
                                                      {84, 197, 104},
                                                      {122, 209, 81},
                                                      {165, 219, 54},
                                                      {210, 226, 27},
                                                      {244, 230, 30},
                                                      {253, 231, 37}}};
  const double clamped = std::isnan(t) ? 0.0 : std::min(std::max(t, 0.0), 1.0);
  const double x = clamped * static_cast<double>(table.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), table.size() - 2);
  const Vec3f mixed =
      glm::mix(Vec3f(table[i]), Vec3f(table[i + 1]), static_cast<float>(x - static_cast<double>(i)));
  return glm::u8vec3(mixed + 0.5f);
}

}  // namespace gnomon::compare
