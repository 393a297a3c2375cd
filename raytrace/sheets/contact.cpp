#include "raytrace/sheets/contact.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

/// The world is cut into slabs across its longest axis. Vertices at one place are in one slab, and a slab asks only the
/// parts that reach into it for their vertices. Each vertex is hashed once, and the hashes of one slab are few enough to
/// be sorted quickly.
class Touching {
 public:
  Touching(const World& world, const std::vector<std::vector<std::uint32_t>>& welded)
      : world_(world), welded_(welded), touches_(world.parts.size()) {
    const Vec3 extent = world.finite_bounds.extent();
    axis_ = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  }

  std::vector<char> run() {
    for (std::size_t i = 0; i < touches_.size(); ++i) touches_[i] = world_.parts[i].kept() ? 0 : 1;
    const std::vector<double> cuts = cut();
    parallel_tasks(cuts.size() - 1, [&](std::size_t k) { mark({cuts[k], cuts[k + 1]}); });
    return touches_;
  }

 private:
  static constexpr std::uint64_t vertices_per_slab = std::uint64_t{1} << 22;  // their hashes take 32 MiB

  /// Where the slabs begin, and infinity: quantiles of a sample, so that about as many vertices lie in each slab.
  std::vector<double> cut() const {
    const std::uint64_t vertices = world_.vertex_count(), slabs = vertices / vertices_per_slab + 8;
    std::vector<double> sample;
    for (std::uint64_t v = 0; v < vertices; v += vertices / 65536 + 1) {
      const double at = world_.position(static_cast<std::uint32_t>(v))[axis_];
      if (std::isfinite(at)) sample.push_back(at);
    }
    std::sort(sample.begin(), sample.end());
    std::vector<double> cuts{-infinity};
    for (std::uint64_t k = 1; k < slabs && !sample.empty(); ++k)
      cuts.push_back(sample[k * sample.size() / slabs]);
    cuts.push_back(infinity);
    return cuts;
  }

  /// use(hash) for a part's vertices in a slab: of a kept part for one vertex at each place, of a flattened one for all.
  template <class Use>
  void each_hash(const WorldPart& part, const Interval& slab, const Use& use) const {
    if (!(part.bounds.min[axis_] < slab.max && slab.min <= part.bounds.max[axis_])) return;
    const auto& welded = welded_[static_cast<std::size_t>(part.mesh - world_.scene->meshes.data())];
    for (std::uint32_t v = 0; v < part.vertex_count(); ++v) {
      if (part.kept() && welded[v] != v) continue;
      const Vec3 p = part.position(v);
      if (slab.min <= p[axis_] && p[axis_] < slab.max) use(hash_of(p));
    }
  }

  /// Returns the hashes of the vertices in a slab, sorted: those of kept parts, or else those of the others.
  std::vector<std::uint64_t> hashes_in(const Interval& slab, bool kept) const {
    std::vector<std::uint64_t> hashes;
    for (const WorldPart& part : world_.parts)
      if (part.kept() == kept) each_hash(part, slab, [&](std::uint64_t hash) { hashes.push_back(hash); });
    sort_numbers(std::span(hashes));
    return hashes;
  }

  /// The hashes that two vertices in a slab have, once each, ascending. Flattened parts count as one: they are joined
  /// to each other in any case.
  std::vector<std::uint64_t> shared_in(const Interval& slab) const {
    std::vector<std::uint64_t> all = hashes_in(slab, true), shared;
    std::vector<std::uint64_t> flat = hashes_in(slab, false);
    flat.erase(std::unique(flat.begin(), flat.end()), flat.end());
    if (!flat.empty()) {
      all.insert(all.end(), flat.begin(), flat.end());
      sort_numbers(std::span(all));
    }
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i] == all[i - 1] && (shared.empty() || shared.back() != all[i])) shared.push_back(all[i]);
    return shared;
  }

  void mark(const Interval& slab) {
    const std::vector<std::uint64_t> shared = shared_in(slab);
    if (shared.empty()) return;
    for (std::size_t i = 0; i < touches_.size(); ++i)
      each_hash(world_.parts[i], slab, [&](std::uint64_t hash) {
        if (std::binary_search(shared.begin(), shared.end(), hash))
          std::atomic_ref(touches_[i]).store(1, std::memory_order_relaxed);
      });
  }

  const World& world_;
  const std::vector<std::vector<std::uint32_t>>& welded_;
  int axis_ = 0;
  std::vector<char> touches_;
};

}  // namespace

std::vector<char> parts_in_contact(const World& world,
                                   const std::vector<std::vector<std::uint32_t>>& welded) {
  return Touching(world, welded).run();
}

}  // namespace gnomon::raytrace
