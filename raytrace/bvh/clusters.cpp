#include "raytrace/bvh/clusters.h"

#include <bit>

#include "scene/base/parallel.h"

namespace gnomon::raytrace::binned {
namespace {

constexpr std::size_t parallel_count = 1u << 12;  // below it one share does all

/// Cubes, so that the boxes of clusters are not longer than they need be.
class CentroidGrid {
 public:
  CentroidGrid(const Box& centroids, std::size_t primitives) : origin_(centroids.min) {
    // Some sixty to a cell if they lie on a surface.
    const int bits = std::clamp((static_cast<int>(std::bit_width(primitives)) - 6) / 2, 2, most_bits);
    const float side = largest_extent(centroids) / static_cast<float>(1 << bits);
    per_ = 1.0f / side;
    for (std::size_t a = 0; a < 3; ++a) {
      const float last = (centroids.max[a] - centroids.min[a]) * per_;
      last_[a] = std::floor(std::min(last, static_cast<float>((1 << bits) - 1)));
    }
    last_[3] = 0.0f;
    stride_[0] = static_cast<std::uint32_t>(last_[0]) + 1;
    stride_[1] = stride_[0] * (static_cast<std::uint32_t>(last_[1]) + 1);
  }
  std::size_t cells() const {
    return static_cast<std::size_t>(stride_[1]) * (static_cast<std::size_t>(last_[2]) + 1);
  }
  /// no_id: the primitive is longer than a cell by so much that it is to be alone.
  std::uint32_t cell_of(const Ref& ref) const {
    if (largest_extent(ref.box) * per_ > most_sides) return no_id;
    const Float4 at = (ref.centroid2().all() - origin_.all()) * Float4::all(per_);
    alignas(16) std::int32_t cell[4];
    store_truncated(min_keep(max_keep(at, Float4::all(0.0f)), last_.all()), cell);
    return static_cast<std::uint32_t>(cell[0]) + stride_[0] * static_cast<std::uint32_t>(cell[1]) +
           stride_[1] * static_cast<std::uint32_t>(cell[2]);
  }

 private:
  static constexpr int most_bits = 7;
  static constexpr float most_sides = 4.0f;
  Row origin_, last_;
  float per_;
  std::array<std::uint32_t, 2> stride_;
};

/// A run of primitives: how many lie in each cell, and which are to be alone.
struct Share {
  std::vector<std::uint32_t> places, alone;
};

template <class In>
class Sorter {
 public:
  Sorter(std::span<const In> in, const Box& centroids)
      : in_(in),
        grid_(centroids, in.size()),
        cell_(in.size()),
        shares_(in.size() < parallel_count
                    ? 1
                    : std::clamp<std::size_t>(static_cast<std::size_t>(threads_for_loops()), 1, 16)) {}

  Clusters run() {
    Clusters out;
    out.order = HugeArray<std::uint32_t>(in_.size());
    for_each_share([&](std::size_t share) { count(share); });
    place(out);
    for_each_share([&](std::size_t share) { scatter(share, out.order); });
    bound(out);
    return out;
  }

 private:
  template <class Work>
  void for_each_share(const Work& work) {
    parallel_tasks(shares_.size(), work);
    leave_if_given_up();
  }
  std::size_t begin_of(std::size_t share) const { return in_.size() * share / shares_.size(); }

  void count(std::size_t share) {
    std::vector<std::uint32_t>& counts = shares_[share].places;
    counts.assign(grid_.cells(), 0);
    for (std::size_t i = begin_of(share); i < begin_of(share + 1); ++i) {
      cell_[i] = grid_.cell_of(as_ref(in_[i]));
      if (cell_[i] == no_id)
        shares_[share].alone.push_back(static_cast<std::uint32_t>(i));
      else
        ++counts[cell_[i]];
    }
  }

  // Afterwards the shares' counts are their places.
  void place(Clusters& out) {
    std::uint32_t sum = 0;
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      const std::uint32_t first = sum;
      for (Share& share : shares_) sum += std::exchange(share.places[cell], sum);
      if (sum != first) out.clusters.push_back({first, sum - first});
    }
    for (const Share& share : shares_)
      for (const std::uint32_t i : share.alone) {
        out.clusters.push_back({sum, 1});
        out.order[sum++] = i;
      }
  }

  void scatter(std::size_t share, HugeArray<std::uint32_t>& order) {
    std::vector<std::uint32_t>& places = shares_[share].places;
    for (std::size_t i = begin_of(share); i < begin_of(share + 1); ++i)
      if (cell_[i] != no_id) order[places[cell_[i]]++] = static_cast<std::uint32_t>(i);
  }

  void bound(Clusters& out) const {
    out.boxes.resize(out.clusters.size());
    parallel_for(out.clusters.size(), 512, [&](std::size_t i) {
      const Cluster cluster = out.clusters[i];
      Box box = Box::empty();
      for (std::uint32_t k = 0; k < cluster.count; ++k)
        box.grow(as_ref(in_[out.order[cluster.first + k]]).box);
      box.min[3] = std::bit_cast<float>(static_cast<std::uint32_t>(i)), box.max[3] = 0.0f;
      out.boxes[i].box = box;
    });
    leave_if_given_up();
  }

  std::span<const In> in_;
  CentroidGrid grid_;
  HugeArray<std::uint32_t> cell_;
  std::vector<Share> shares_;
};

}  // namespace

Clusters cluster_by_cells(std::span<const BoxRef> boxes, const Box& centroids) {
  return Sorter<BoxRef>(boxes, centroids).run();
}
Clusters cluster_by_cells(std::span<const Ref> refs, const Box& centroids) {
  return Sorter<Ref>(refs, centroids).run();
}

Box centroid_bounds(std::span<const BoxRef> boxes) {
  return parallel_reduce(
      boxes.size(), parallel_count, Box::empty(),
      [&](std::size_t first, std::size_t last, Box box) {
        for (std::size_t i = first; i < last; ++i) {
          const Row c = ref_of(boxes[i]).centroid2();
          lower(box.min, c), raise(box.max, c);
        }
        return box;
      },
      [](Box a, const Box& b) {
        a.grow(b);
        return a;
      });
}

bool grid_applies(const Box& centroids) {
  const float extent = largest_extent(centroids);
  return extent > 1e-30f && extent < 1e30f;
}

}  // namespace gnomon::raytrace::binned
