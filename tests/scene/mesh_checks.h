// What a generated mesh promises, as numbers: edges matched, triangles with area, volume. Vertices are welded
// by position (bitwise), as the sheets of the comparison weld them.
#pragma once

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

#include "scene/scene.h"

namespace gnomon::test {

struct MeshReport {
  std::size_t open_edges =
      0;  ///< directed edges without exactly one opposite: 0 on closed oriented manifolds
  std::size_t repeated_edges = 0;  ///< directed edges used more than once: 0 on manifolds
  std::size_t degenerate = 0;      ///< triangles without area
  std::size_t duplicates = 0;      ///< triangles with the same three corners as another
  std::size_t wrong_normals =
      0;  ///< corners whose normal is not unit length or points to the triangle's back
  double least_area = infinity;
  double volume = 0.0;  ///< signed; positive when wound outwards
  double area = 0.0;
  Aabb bounds;
};

inline MeshReport inspect(const Mesh& mesh) {
  MeshReport r;
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::map<Vec3, std::uint32_t, decltype(less)> weld(less);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> id{};
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = mesh.positions[t[k]];
      r.bounds.grow(p[k]);
      id[k] = weld.try_emplace(p[k], static_cast<std::uint32_t>(weld.size())).first->second;
    }
    for (std::size_t k = 0; k < 3; ++k) ++edges[{id[k], id[(k + 1) % 3]}];
    const Vec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double area = 0.5 * glm::length(n);
    if (!(area > 0.0)) ++r.degenerate;
    r.area += area;
    r.least_area = std::min(r.least_area, area);
    r.volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
    for (const std::uint32_t i : t) {
      if (mesh.normals.empty()) continue;
      const Vec3 normal(mesh.normals[i]);
      if (!(std::abs(glm::length(normal) - 1.0) < 1e-5) || !(glm::dot(normal, n) > 0.0)) ++r.wrong_normals;
    }
    std::sort(id.begin(), id.end());
    if (++faces[id] > 1) ++r.duplicates;
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (back == edges.end() || back->second != count) ++r.open_edges;
    if (count > 1) ++r.repeated_edges;
  }
  return r;
}

/// The parts that do not promise to be closed.
inline bool is_open(std::string_view kind, std::string_view part_name) {
  return kind == "floor" || kind == "teapot" || part_name == "leaf" || part_name == "blade" ||
         part_name == "flower";
}

}  // namespace gnomon::test
