#include "compare/result/palette.h"

#include <array>
#include <cmath>

namespace gnomon::compare {

namespace {

// Between the entries of an evenly spaced table, linear in sRGB.
template <std::size_t count>
glm::u8vec3 between(const std::array<glm::u8vec3, count>& table, double t) {
  if (!(t > 0.0)) return table.front();
  if (t >= 1.0) return table.back();
  const double x = t * static_cast<double>(count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), count - 2);
  const Vec3f mixed =
      glm::mix(Vec3f(table[i]), Vec3f(table[i + 1]), static_cast<float>(x - static_cast<double>(i)));
  return glm::u8vec3(mixed + 0.5f);
}

}  // namespace

glm::u8vec3 grey_backdrop(const glm::u8vec3& c) {
  const float luma = 0.2126f * static_cast<float>(c.r) + 0.7152f * static_cast<float>(c.g) +
                     0.0722f * static_cast<float>(c.b);
  return glm::u8vec3(static_cast<std::uint8_t>(64.5f + luma * (168.0f / 255.0f)));
}

glm::u8vec3 viridis(double t) {
  // Every sixteenth entry of matplotlib's table of 256, the last one included.
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
  return between(table, t);
}

glm::u8vec3 magma(double t) {
  // Nine evenly spaced entries of matplotlib's table.
  static constexpr std::array<glm::u8vec3, 9> table{{{0, 0, 4},
                                                     {29, 17, 71},
                                                     {81, 18, 124},
                                                     {130, 38, 129},
                                                     {182, 54, 121},
                                                     {230, 81, 100},
                                                     {251, 136, 97},
                                                     {254, 194, 135},
                                                     {252, 253, 191}}};
  return between(table, t);
}

}  // namespace gnomon::compare
