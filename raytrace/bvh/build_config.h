// What the hierarchy's builder is tuned by. Every choice gives a hierarchy with the same answers; these are the
// fastest together on the scenes of docs/performance.md.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gnomon::raytrace::binned {

struct BuildConfig {
  /// Bins along each axis for runs of neighbours and for ranges of more than `sorted_size` primitives, and in a
  /// treelet, where there are fewer primitives to put into them.
  static constexpr std::size_t most_bins = 16, few_bins = 8;
  /// Primitives of the ranges that are split one primitive at a time, by one thread: what fits its cache.
  static constexpr std::uint32_t treelet_size = 256;
  /// Primitives below which a task for another thread costs more than it gains.
  static constexpr std::uint32_t parallel_threshold = 1024;
  /// Clusters below which there are too few to choose well between: the range gets a grid of its own.
  static constexpr std::uint32_t few_clusters = 8;
  /// Primitives that become a leaf without asking what a split would gain: half the nodes, and rays are no
  /// slower for it. At most BvhChild::max_leaf.
  static constexpr std::uint32_t leaf_size = 4;
  /// Primitives up to which every split of their sorted order is tried instead of bins; at most 16.
  static constexpr std::uint32_t sorted_size = 16;
  /// A treelet's axes along which centroids spread less than this share of the most are not tried: one as flat
  /// as that is hardly ever the best.
  static constexpr float flat = 0.5f;
  /// Binary splits; a range deeper than this is split at the median, so that at most 32 more levels follow
  /// (Bvh::max_depth).
  static constexpr int sah_depth = 44;
};

}  // namespace gnomon::raytrace::binned
