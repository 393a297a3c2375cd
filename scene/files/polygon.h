// Polygons of model files, cut into triangles by ear clipping (Meisters 1975): concave ones come out right,
// and n corners always give n - 2 triangles, however degenerate or self-crossing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/base/parallel.h"
#include "scene/math.h"
#include "scene/scene.h"

namespace gnomon {

/// Loaders refuse more: to triangulate a polygon takes time with the square of its corners.
inline constexpr std::size_t max_polygon_corners = 4096;

/// Triangles as indices into `corners` (at least three), wound as the polygon is.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const Vec3> corners);

// All triangles of a scene where they lie in the world, gone through on every thread. What comes of them is the same
// for any number of threads: the scene is cut into the same blocks, and what these give is joined in their order.

struct PlacedTriangle {
  Vec3 a, b, c;
  double turn;  ///< -1 where the instance mirrors its mesh, else 1
  std::uint32_t material;
  /// By the right-hand rule, with twice the area.
  Vec3 normal() const { return turn * glm::cross(b - a, c - a); }
};

/// Visits the triangles of one instance that have these numbers in its mesh.
template <class Visit>
void visit_placed(const Scene& scene, const MeshInstance& instance, std::size_t first, std::size_t last,
                  const Visit& visit) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const auto place = [&](std::uint32_t v) {
    return Vec3(instance.world_from_object * Vec4(mesh.positions[v], 1.0));
  };
  const double turn = glm::determinant(Mat3(instance.world_from_object)) < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = first; i < last; ++i) {
    const auto& t = mesh.triangles[i];
    visit(PlacedTriangle{place(t[0]), place(t[1]), place(t[2]), turn,
                         mesh.triangle_materials.empty() ? instance.material : mesh.triangle_materials[i]});
  }
}

/// The sum of `none` and what add(sum, triangle) makes of all triangles; join(sum, more) adds up two sums.
template <class Sum, class Add, class Join>
Sum over_placed_triangles(const Scene& scene, const Sum& none, const Add& add, const Join& join) {
  std::vector<std::uint64_t> first{0};
  for (const MeshInstance& instance : scene.instances)
    first.push_back(first.back() + scene.meshes[instance.mesh].triangles.size());
  constexpr std::size_t at_a_time = 8192;
  return parallel_reduce(
      first.back(), at_a_time, none,
      [&](std::size_t begin, std::size_t end, Sum sum) {
        auto i =
            static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), begin) - first.begin() - 1);
        for (std::uint64_t at = begin; at < end; at = first[++i])
          visit_placed(scene, scene.instances[i], at - first[i],
                       std::min<std::uint64_t>(end, first[i + 1]) - first[i],
                       [&](const PlacedTriangle& t) { add(sum, t); });
        return sum;
      },
      [&](Sum sum, const Sum& more) {
        join(sum, more);
        return sum;
      });
}

}  // namespace gnomon
