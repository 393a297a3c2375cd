#include "raytrace/bvh/leaf_primitives.h"

#include <algorithm>
#include <bit>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {

/// The corners of a group of leaves, each once. Equal vertices go first, which is quick to see, and then those of equal
/// bits, for files give a vertex twice where its normal or its texture has a seam. In passes over the whole group, so that
/// no load waits for what another one says.
class LeafGroup {
 public:
  /// Numbers the corners of the leaves from `first` on; returns for each number a vertex that lies there.
  std::vector<std::uint32_t> number(const LeafPrimitives::Source& source, std::size_t first,
                                    std::span<LeafPrimitives::Triangle> leaves) {
    source.vertices(first, {vertex_.data(), leaves.size()});
    find_distinct(leaves.size());
    source.positions(distinct_.data(), {position_.data(), distinct_count_});
    std::vector<std::uint32_t> corners = number_positions();
    for (std::size_t i = 0; i < leaves.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) leaves[i][k] = corner_[vertex_[i][k]];
    return corners;
  }

 private:
  static constexpr std::size_t most = 3 * LeafPrimitives::group_size,
                               slot_bits = LeafPrimitives::group_bits + 2,
                               slots = std::size_t{1} << slot_bits;
  static constexpr std::uint16_t vacant = 0xffff;
  static constexpr std::uint64_t factor = 0x9e3779b97f4a7c15u;
  static_assert(most < slots && slot_bits < 16);

  /// Hashed with linear probing: the first slot that is vacant or of which is(slot) holds.
  template <class Is>
  std::size_t find(std::uint64_t hash, const Is& is) const {
    std::size_t at = hash >> (64 - slot_bits);
    while (slot_[at] != vacant && !is(slot_[at])) at = (at + 1) % slots;
    return at;
  }

  /// Finds the different ones among the leaves' vertices, and puts in each one's place which of these it is.
  void find_distinct(std::size_t leaves) {
    slot_.fill(vacant), distinct_count_ = 0;
    for (std::size_t i = 0; i < leaves; ++i)
      for (std::uint32_t& vertex : vertex_[i]) {
        const std::size_t at =
            find(vertex * factor, [&](std::uint16_t other) { return distinct_[other] == vertex; });
        distinct_[distinct_count_] = vertex;
        if (slot_[at] == vacant) slot_[at] = static_cast<std::uint16_t>(distinct_count_++);
        vertex = slot_[at];
      }
  }

  std::vector<std::uint32_t> number_positions() {
    slot_.fill(vacant);
    std::vector<std::uint32_t> corners;
    corners.reserve(distinct_count_);
    const auto bits_of = [&](std::size_t i) {
      return std::bit_cast<std::array<std::uint64_t, 3>>(position_[i]);
    };
    for (std::size_t i = 0; i < distinct_count_; ++i) {
      const auto bits = bits_of(i);
      const std::size_t at = find(((bits[0] * factor ^ bits[1]) * factor ^ bits[2]) * factor,
                                  [&](std::uint16_t other) { return bits_of(other) == bits; });
      if (slot_[at] == vacant) {
        slot_[at] = static_cast<std::uint16_t>(i), corner_[i] = static_cast<std::uint16_t>(corners.size());
        corners.push_back(distinct_[i]);
      } else {
        corner_[i] = corner_[slot_[at]];
      }
    }
    return corners;
  }

  std::array<std::uint16_t, slots> slot_;                                        ///< distinct vertices
  std::array<std::array<std::uint32_t, 3>, LeafPrimitives::group_size> vertex_;  ///< of leaves
  std::array<std::uint32_t, most + 1> distinct_;  ///< vertices, and room to try one more
  std::size_t distinct_count_ = 0;
  std::array<Vec3, most> position_;         ///< of the distinct vertices
  std::array<std::uint16_t, most> corner_;  ///< of the distinct vertices
};

LeafPrimitives::LeafPrimitives(std::size_t count, const Source& source) : triangles_(count) {
  const std::size_t groups = (count + group_size - 1) / group_size;
  std::vector<std::vector<std::uint32_t>> corners(groups);  // vertices
  parallel_for(groups, [&](std::size_t g) {
    const std::size_t first = g * group_size, leaves = std::min(count - first, group_size);
    LeafGroup group;
    corners[g] = group.number(source, first, {triangles_.data() + first, leaves});
  });
  leave_if_given_up();
  std::vector<std::size_t> first(groups + 1, 0);
  for (std::size_t g = 0; g < groups; ++g) first[g + 1] = first[g] + corners[g].size();
  corners_ = HugeArray<Vec3>(first[groups] + 1);
  corners_[first[groups]] = Vec3(0.0);
  for (std::size_t g = 0; g < groups; ++g) groups_.push_back(corners_.data() + first[g]);
  parallel_for(groups, [&](std::size_t g) {
    source.positions(corners[g].data(), {corners_.data() + first[g], corners[g].size()});
  });
  leave_if_given_up();
}

namespace {

/// Vertices of primitives that are given by themselves.
constexpr auto own_vertices = [](std::size_t first, std::span<std::array<std::uint32_t, 3>> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto vertex = static_cast<std::uint32_t>(3 * (first + i));
    out[i] = {vertex, vertex + 1, vertex + 2};
  }
};

}  // namespace

LeafPrimitives::LeafPrimitives(std::span<const LeafPrimitive> primitives)
    : LeafPrimitives(primitives.size(),
                     {own_vertices, [&](const std::uint32_t* vertices, std::span<Vec3> out) {
                        for (std::size_t i = 0; i < out.size(); ++i)
                          out[i] = primitives[vertices[i] / 3].corner(vertices[i] % 3);
                      }}) {}

std::uint64_t LeafPrimitives::bytes() const {
  return triangles_.bytes() + corners_.bytes() + groups_.size() * sizeof(const Vec3*);
}

}  // namespace gnomon::raytrace
