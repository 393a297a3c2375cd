// A loop over a world's triangles for who looks for the least or the largest of something. Most blocks are left out, for
// their boxes show that they hold nothing better than what was found so far.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "scene/base/parallel.h"
#include "scene/world.h"

namespace gnomon {

/// `sum` and what add(sum, part, triangle of the part) makes of all triangles, joined by join(sum, other sum); but for
/// blocks of whose boxes makes_no_difference(sum, box) says so. Joined with itself a sum must stay what it is. Blocks that
/// follow each other are taken far from each other, so that the first ones tell much about all. The result is the same for
/// any number of threads.
template <class Sum, class Without, class Add, class Join>
Sum over_blocks(const World& world, Sum sum, const Without& makes_no_difference, const Add& add,
                const Join& join) {
  constexpr std::size_t at_once = 32;
  const std::vector<TriangleBlock>& blocks = world.blocks;
  std::vector<const TriangleBlock*> some;
  const auto add_block = [&](std::size_t first, std::size_t last, Sum more) {
    for (std::size_t b = first; b < last; ++b)
      for (std::uint32_t i = 0; i < some[b]->count; ++i)
        add(more, world.parts[some[b]->part], some[b]->first + i);
    return more;
  };
  const auto add_some = [&] {
    sum = parallel_reduce(some.size(), 1, sum, add_block, [&](Sum left, const Sum& right) {
      join(left, right);
      return left;
    });
    some.clear();
  };
  auto stride = static_cast<std::size_t>(0.618 * static_cast<double>(blocks.size()));
  while (std::gcd(stride, blocks.size()) > 1) ++stride;
  for (std::size_t i = 0, at = 0; i < blocks.size(); ++i, at = (at + stride) % blocks.size()) {
    if (makes_no_difference(sum, blocks[at].bounds)) continue;
    some.push_back(&blocks[at]);
    if (some.size() == at_once) add_some();
  }
  if (!some.empty()) add_some();
  return sum;
}

/// The largest of dot(direction, p), p in the box.
inline double farthest_along(const Aabb& box, const Vec3& direction) {
  return glm::dot(direction, glm::mix(box.min, box.max, glm::greaterThan(direction, Vec3(0.0))));
}

}  // namespace gnomon
