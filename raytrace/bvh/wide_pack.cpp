#include "raytrace/bvh/wide_tree.h"

#include <bit>
#include <cmath>

namespace gnomon::raytrace {
namespace {

constexpr std::size_t half_of_step = 3, half_of_size = 4;

/// The least float of those that the halves can say which is not below `least`, or the one after it.
void set_above(float least, std::size_t i, WideLeaf& leaf) {
  leaf.half[i] = static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(least) >> 16) + 1);
}

/// Near the box's middle. Not near zero, where the lower half alone would make a denormal number.
void set_anchor(const WideBox& box, float reach, WideLeaf& leaf) {
  for (std::size_t a = 0; a < 3; ++a) {
    const float middle = 0.5f * box.at[a] + 0.5f * box.at[3 + a];
    const float anchor = std::copysign(std::max(std::abs(middle), 0x1p-20f * reach), middle);
    leaf.half[a] = static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(anchor) >> 16);
  }
}

}  // namespace

void pack_corners(const WideBox& box, std::span<const std::array<double, 3>> corners, double longest_edge,
                  float reach, WideLeaf& leaf) {
  constexpr double most = 32767.0;
  set_anchor(box, reach, leaf);
  const auto from_anchor = [&](const std::array<double, 3>& corner, std::size_t a) {
    return corner[a] - static_cast<double>(leaf.anchor(a));
  };
  double extent = 0x1p-14 * static_cast<double>(reach);
  for (const auto& corner : corners)
    for (std::size_t a = 0; a < 3; ++a) extent = std::max(extent, std::abs(from_anchor(corner, a)));
  set_above(static_cast<float>(extent / most), half_of_step, leaf);
  set_above(static_cast<float>(13.0 * std::max(longest_edge, 0x1p-16 * static_cast<double>(reach))),
            half_of_size, leaf);
  const auto step = static_cast<double>(leaf.step());
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < leaf_corners; ++i)
      leaf.corner[a][i] = i < corners.size()
                              ? static_cast<std::int16_t>(std::nearbyint(from_anchor(corners[i], a) / step))
                              : std::int16_t{0};
}

}  // namespace gnomon::raytrace
