// Which triangle lies across which edge, with vertices welded by exact position. Sorting instead of hashing,
// so that the result is the same for any number of threads.
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <tuple>

#include "raytrace/sheets.h"
#include "scene/stages.h"

namespace gnomon::raytrace {
namespace {

/// The lowest vertex index at each vertex's position (-0 equals 0).
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = positions[i];
    return std::tuple(p.x, p.y, p.z);
  };
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<std::uint32_t> welded(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

struct HalfEdge {
  std::uint32_t low, high;
  std::uint32_t place;  // 3 * triangle + edge
  bool forwards;        // from low to high
};

}  // namespace

Topology::Topology(const World& world)
    : across_(3 * world.triangles.size(), boundary), welded_(across_.size()) {
  const TimedStage stage("topology");
  const std::vector<std::uint32_t> vertex = weld(world.positions);
  std::vector<HalfEdge> edges(across_.size());
  tbb::parallel_for(std::size_t{0}, world.triangles.size(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = vertex[world.triangles[t][k]], b = vertex[world.triangles[t][(k + 1) % 3]];
      welded_[3 * t + k] = a;
      edges[3 * t + k] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * t + k), a < b};
    }
  });
  tbb::parallel_sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.place) < std::tie(b.low, b.high, b.place);
  });
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t end = first + 1;
    while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high)
      ++end;
    const HalfEdge& a = edges[first];
    const bool shared = end - first == 2 && a.low != a.high && a.forwards != edges[first + 1].forwards &&
                        a.place / 3 != edges[first + 1].place / 3;
    if (shared) {
      across_[a.place] = edges[first + 1].place / 3;
      across_[edges[first + 1].place] = a.place / 3;
    } else if (end - first > 1) {
      for (std::size_t i = first; i < end; ++i) across_[edges[i].place] = non_manifold;
    }
    first = end;
  }
}

}  // namespace gnomon::raytrace
