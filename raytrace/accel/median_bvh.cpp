#include "raytrace/accel/median_bvh.h"

#include <algorithm>
#include <numeric>

namespace gnomon::raytrace {
namespace {

constexpr std::uint32_t median_leaf_size = 5;

class MedianBuilder {
 public:
  MedianBuilder(const CellItems& items, MedianBvh& out) : items_(items), out_(out) {}

  void build(std::uint32_t first, std::uint32_t count) {
    const std::size_t index = out_.nodes.size();
    const CellBox box = bounds(first, count);
    out_.nodes.push_back({box, first, count});
    if (count <= median_leaf_size) return;
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (box.extent(a) > box.extent(axis)) axis = a;
    const auto begin = out_.items.begin() + first;
    // By (centroid, place): defined even when all centroids are equal.
    std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      const float ca = items_.box(a).min[axis] + items_.box(a).max[axis];
      const float cb = items_.box(b).min[axis] + items_.box(b).max[axis];
      return ca != cb ? ca < cb : a < b;
    });
    build(first, count / 2);
    out_.nodes[index].first = static_cast<std::uint32_t>(out_.nodes.size());
    out_.nodes[index].count = 0;
    build(first + count / 2, count - count / 2);
  }

 private:
  CellBox bounds(std::uint32_t first, std::uint32_t count) const {
    const BoxRef& start = items_.box(out_.items[first]);
    CellBox box{start.min, start.max};
    for (std::uint32_t i = first + 1; i < first + count; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        box.min[a] = std::min(box.min[a], items_.box(out_.items[i]).min[a]);
        box.max[a] = std::max(box.max[a], items_.box(out_.items[i]).max[a]);
      }
    return box;
  }

  const CellItems& items_;
  MedianBvh& out_;
};

}  // namespace

MedianBvh build_median_bvh(const CellItems& items) {
  MedianBvh bvh;
  if (items.count() == 0) return bvh;
  bvh.items.resize(items.count());
  std::iota(bvh.items.begin(), bvh.items.end(), 0u);
  MedianBuilder(items, bvh).build(0, items.count());
  return bvh;
}

}  // namespace gnomon::raytrace
