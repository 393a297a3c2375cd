#include "raytrace/bvh/leaf_primitives.h"

#include <algorithm>
#include <bit>

#include "raytrace/given_up.h"
#include "scene/parallel.h"

namespace gnomon::raytrace {

/// The corners of a group of leaves, each once: equal vertices first, which is quick to see, and then those of equal
/// bits, for files give a vertex twice where its normal or its texture has a seam.
class LeafGroup {
 public:
  LeafGroup() {
    by_vertex_.fill(vacant), by_position_.fill(vacant);
    corners_.reserve(LeafPrimitives::group_size);
  }

  LeafPrimitives::Triangle triangle(const LeafPrimitives::Source& source, std::size_t leaf) {
    const auto vertices = source.vertices(leaf);
    LeafPrimitives::Triangle out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = corner_of(vertices[k], source);
    return out;
  }
  const std::vector<Vec3>& corners() const { return corners_; }

 private:
  static constexpr std::size_t slot_bits = LeafPrimitives::group_bits + 2,
                               slots = std::size_t{1} << slot_bits;
  static constexpr std::uint16_t vacant = 0xffff;
  static constexpr std::uint64_t factor = 0x9e3779b97f4a7c15u;
  static_assert(3 * LeafPrimitives::group_size < slots && slot_bits < 16);

  /// Hashed with linear probing: where is(slot) first holds, or the first vacant slot.
  template <class Is>
  static std::size_t find(const std::array<std::uint16_t, slots>& corner, std::uint64_t hash, const Is& is) {
    std::size_t at = hash >> (64 - slot_bits);
    while (corner[at] != vacant && !is(at)) at = (at + 1) % slots;
    return at;
  }

  std::uint16_t corner_of(std::uint32_t vertex, const LeafPrimitives::Source& source) {
    const std::size_t at =
        find(by_vertex_, vertex * factor, [&](std::size_t slot) { return vertex_[slot] == vertex; });
    if (by_vertex_[at] == vacant) vertex_[at] = vertex, by_vertex_[at] = corner_at(source.position(vertex));
    return by_vertex_[at];
  }
  std::uint16_t corner_at(const Vec3& position) {
    const auto bits = std::bit_cast<std::array<std::uint64_t, 3>>(position);
    const std::size_t at =
        find(by_position_, ((bits[0] * factor ^ bits[1]) * factor ^ bits[2]) * factor, [&](std::size_t slot) {
          return std::bit_cast<std::array<std::uint64_t, 3>>(corners_[by_position_[slot]]) == bits;
        });
    if (by_position_[at] == vacant) {
      by_position_[at] = static_cast<std::uint16_t>(corners_.size());
      corners_.push_back(position);
    }
    return by_position_[at];
  }

  std::array<std::uint16_t, slots> by_vertex_, by_position_;  ///< corners
  std::array<std::uint32_t, slots> vertex_;  ///< of the corner in the same slot of by_vertex_
  std::vector<Vec3> corners_;
};

LeafPrimitives::LeafPrimitives(std::size_t count, const Source& source) : triangles_(count) {
  const std::size_t groups = (count + group_size - 1) / group_size;
  std::vector<std::vector<Vec3>> corners(groups);
  parallel_for(groups, [&](std::size_t g) {
    LeafGroup group;
    const std::size_t end = std::min(count, (g + 1) * group_size);
    for (std::size_t i = g * group_size; i < end; ++i) triangles_[i] = group.triangle(source, i);
    corners[g] = group.corners();
  });
  leave_if_given_up();
  std::vector<std::size_t> first(groups + 1, 0);
  for (std::size_t g = 0; g < groups; ++g) first[g + 1] = first[g] + corners[g].size();
  corners_ = HugeArray<Vec3>(first[groups] + 1);
  corners_[first[groups]] = Vec3(0.0);
  for (std::size_t g = 0; g < groups; ++g) groups_.push_back(corners_.data() + first[g]);
  parallel_for(groups, [&](std::size_t g) {
    std::copy(corners[g].begin(), corners[g].end(), corners_.data() + first[g]);
  });
  leave_if_given_up();
}

namespace {

/// Vertices of primitives that are given by themselves.
constexpr auto own_vertices = [](std::size_t leaf) {
  const auto first = static_cast<std::uint32_t>(3 * leaf);
  return std::array{first, first + 1, first + 2};
};

}  // namespace

LeafPrimitives::LeafPrimitives(std::span<const LeafPrimitive> primitives)
    : LeafPrimitives(primitives.size(), {own_vertices, [&](std::uint32_t vertex) {
                                           return primitives[vertex / 3].corner(vertex % 3);
                                         }}) {}

std::uint64_t LeafPrimitives::bytes() const {
  return triangles_.bytes() + corners_.bytes() + groups_.size() * sizeof(const Vec3*);
}

}  // namespace gnomon::raytrace
