#include <functional>
#include <new>
#include <thread>

#include "raytrace/bvh/wide_tree.h"
#include "scene/base/parallel.h"
#include "scene/base/timing.h"

namespace gnomon::raytrace {

// Isolated, for else a thread that waits for the rest of the tree would begin another tile of the picture.
void WideOnDemand::collapse(const Bvh& bvh, const World& world) {
  if (begun_.exchange(true)) return;
  try {
    run_isolated([&] {
      const Stopwatch watch;
      const WideTree* tree = collapse_bvh(bvh, world, plain_).release();
      collapse_ms_ = watch.elapsed_ms();
      ready_.store(tree, std::memory_order_release);
    });
  } catch (const std::bad_alloc&) {  // not tried again: the default hierarchy answers every ray
  } catch (...) {                    // given up with the work around it: the next work begins again
    begun_ = false;
    throw;
  }
}

std::uint64_t WideOnDemand::bytes() const {
  const WideTree* tree = ready_.load(std::memory_order_acquire);
  return tree != nullptr ? tree->bytes() : 0;
}

// Each count tells now and then. Collapsing costs for a primitive a quarter to four fifths of what a ray saves; who casts a
// sixteenth as many rays as there are primitives will cast more.
const WideTree* WideOnDemand::count_ray(const Bvh& bvh, const World& world) {
  constexpr unsigned told_at_once = 256, least = 4096;
  const std::uint64_t thread = std::hash<std::thread::id>{}(std::this_thread::get_id());
  RayCount& count = counts_[(thread * 0x9e3779b97f4a7c15u) >> 60];
  if ((count.rays.fetch_add(1, std::memory_order_relaxed) + 1) % told_at_once != 0) return nullptr;
  std::uint64_t primitives = bvh.primitives.size();
  for (const Bvh& tree : bvh.trees) primitives += tree.primitives.size();
  if ((rays_ += told_at_once) >= least + primitives / 16) collapse(bvh, world);
  return ready_.load(std::memory_order_acquire);
}

}  // namespace gnomon::raytrace
