// The primitives of a hierarchy in leaf order. Triangles of neighbouring leaves share most of their corners, so these are
// stored once for every few thousand leaves. A triangle is three numbers of sixteen bits. Of a closed mesh that is some
// 20 bytes for 72.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/huge_array.h"
#include "scene/base/parallel.h"
#include "scene/math.h"

namespace gnomon::raytrace {

/// A triangle's corners (x0 y0 z0 x1 ... z2), or a sphere's centre and radius in the first four; nothing
/// for a solid (scene/shapes/solid.h), which is looked up by its id.
struct LeafPrimitive {
  std::array<double, 9> v;
  Vec3 corner(std::size_t k) const { return {v[3 * k], v[3 * k + 1], v[3 * k + 2]}; }
};

/// Where a triangle's corners are: three doubles each, and a fourth that may be read but means nothing.
using CornerPointers = std::array<const double*, 3>;

/// Corners that are stored nowhere else.
struct PlacedCorners {
  std::array<std::array<double, 4>, 3> corner;
  CornerPointers put(const LeafPrimitive& p) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = {p.v[3 * k], p.v[3 * k + 1], p.v[3 * k + 2], 0.0};
    return {corner[0].data(), corner[1].data(), corner[2].data()};
  }
};

class LeafPrimitives {
 public:
  /// What they are made of. Both may be asked from any thread, and fill all that `out` has room for.
  struct Source {
    /// Gives the vertices of the leaves from `first` on.
    FunctionRef<void(std::size_t first, std::span<std::array<std::uint32_t, 3>> out)> vertices;
    /// Gives the positions of vertices; several may have the same.
    FunctionRef<void(const std::uint32_t* vertices, std::span<Vec3> out)> positions;
  };
  LeafPrimitives() = default;
  LeafPrimitives(std::size_t count, const Source& source);
  explicit LeafPrimitives(std::span<const LeafPrimitive> primitives);

  std::size_t size() const { return triangles_.size(); }
  bool empty() const { return size() == 0; }
  std::uint64_t bytes() const;

  LeafPrimitive operator[](std::size_t leaf) const {
    const auto [a, b, c] = corners(leaf);
    return {{a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]}};
  }
  CornerPointers corners(std::size_t leaf) const {
    const Triangle& t = triangles_[leaf];
    const Vec3* group = groups_[leaf >> group_bits];
    return {&group[t[0]].x, &group[t[1]].x, &group[t[2]].x};
  }
  /// The leaf's corners by number; leaves that share a corner give it the same number, unless they are more than a few
  /// thousand leaves apart.
  std::array<std::uint32_t, 3> corner_numbers(std::size_t leaf) const {
    const Triangle& t = triangles_[leaf];
    const auto first = static_cast<std::uint32_t>(groups_[leaf >> group_bits] - corners_.data());
    return {first + t[0], first + t[1], first + t[2]};
  }
  const Vec3& corner(std::uint32_t number) const { return corners_[number]; }
  /// Asks memory for what says which corners the leaves from `first` on have. `count` is not 0.
  [[gnu::always_inline]] void prefetch_triangles(std::size_t first, std::size_t count) const {
    constexpr std::size_t line = 64 / sizeof(Triangle);
    for (std::size_t i = first; i < first + count; i += line) __builtin_prefetch(&triangles_[i]);
    __builtin_prefetch(&triangles_[first + count - 1]);
  }

  /// Fetches one leaf of the tree for single rays: the lines of its first and last triangle, between which is at most one.
  [[gnu::always_inline]] void prefetch_leaf(std::size_t first, std::size_t count) const {
    __builtin_prefetch(&triangles_[first]);
    __builtin_prefetch(&triangles_[first + count - 1]);
  }

 private:
  using Triangle = std::array<std::uint16_t, 3>;  ///< numbers of corners in the group
  static constexpr std::size_t group_bits = 12, group_size = std::size_t{1} << group_bits;
  friend class LeafGroup;

  HugeArray<Triangle> triangles_;    ///< by leaf
  HugeArray<Vec3> corners_;          ///< by groups of leaves, and one more to be read
  std::vector<const Vec3*> groups_;  ///< the first of a group's corners
};

}  // namespace gnomon::raytrace
