// The leaves that a block's traversal has found and whose primitives are not yet set up (view_block.cpp, shadow_block.cpp).

#if defined(GNOMON_RAYTRACE_PACKETS_PENDING_LEAVES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_PENDING_LEAVES_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_PENDING_LEAVES_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_PENDING_LEAVES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "raytrace/packets/block_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {

/// Leaves in the order in which they came. Memory is asked for a leaf's triangles in two steps, for where their corners
/// are is read from memory, too. It is asked for the numbers of a run's corners when the run comes, and for the corners
/// when the next run does.
class PendingLeaves {
 public:
  explicit PendingLeaves(const Bvh& bvh) : bvh_(bvh) {}

  /// `tiles`: those that the run may touch, or anything where nobody asks tiles_of(). No more than 7 run_size may be
  /// waiting.
  void put(LeafRange run, std::uint16_t tiles) {
    prefetch_triangles(run), prefetch_corners(last_);
    last_ = run;
    if (end_ + run.count > most) {
      std::copy(leaves_ + begin_, leaves_ + end_, leaves_), std::copy(tiles_ + begin_, tiles_ + end_, tiles_);
      end_ -= begin_, begin_ = 0;
    }
    for (std::uint32_t k = 0; k < run.count; ++k) tiles_[end_] = tiles, leaves_[end_++] = run.first + k;
  }
  std::size_t count() const { return end_ - begin_; }
  std::span<const std::uint32_t> first(std::size_t count) const { return {leaves_ + begin_, count}; }
  unsigned tiles_of(std::size_t i) const { return tiles_[begin_ + i]; }
  void drop(std::size_t count) { begin_ += count; }

 private:
  // Inlined by force: GCC takes functions that do nothing else for ones without effects, and leaves their calls out.
  HWY_INLINE bool is_here(LeafRange run) const {  // not an instance's
    return run.first + std::size_t{run.count} <= bvh_.primitives.size();
  }
  HWY_INLINE void prefetch_triangles(LeafRange run) const {
    if (!is_here(run)) return;
    bvh_.primitives.prefetch_triangles(run.first, run.count);
    __builtin_prefetch(&bvh_.ids[run.first]), __builtin_prefetch(&bvh_.ids[run.first + run.count - 1]);
  }
  HWY_INLINE void prefetch_corners(LeafRange run) const {
    if (!is_here(run)) return;
    for (std::uint32_t i = 0; i < run.count; ++i)
      __builtin_prefetch(bvh_.primitives.corners(run.first + i)[0]);
  }

  static constexpr std::size_t most = 8 * std::size_t{run_size};
  const Bvh& bvh_;
  LeafRange last_{0, 0};
  std::uint32_t leaves_[most];
  std::uint16_t tiles_[most];
  std::size_t begin_ = 0, end_ = 0;  ///< of those that wait
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
