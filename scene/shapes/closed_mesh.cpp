#include "scene/shapes/closed_mesh.h"

#include <algorithm>
#include <numeric>

#include "scene/shapes/weld.h"

namespace gnomon {
namespace {

bool before(const Vec3& a, const Vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace

std::vector<std::uint32_t> welded(std::span<const Vec3> positions) {
  std::vector<std::uint32_t> order(positions.size()), out(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return before(positions[a], positions[b]); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    out[order[i]] = same ? out[order[i - 1]] : static_cast<std::uint32_t>(i);
  }
  return out;
}

std::uint64_t open_edges(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles) {
  if (triangles.empty()) return 0;
  std::uint32_t first = triangles[0][0], last = first;
  for (const MeshTriangle& t : triangles)
    for (const std::uint32_t corner : t) first = std::min(first, corner), last = std::max(last, corner);
  const std::vector<std::uint32_t> number = welded(positions.subspan(first, last - first + 1));
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * triangles.size());
  for (const MeshTriangle& t : triangles) {
    const std::array<std::uint32_t, 3> corner{number[t[0] - first], number[t[1] - first],
                                              number[t[2] - first]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::uint64_t odd = 0;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    odd += (end - i) % 2;
    i = end;
  }
  return odd;
}

}  // namespace gnomon
