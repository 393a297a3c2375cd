// Primitives sorted by the cells of a cubic grid over their centroids. The hierarchy's builder then splits
// runs of neighbours instead of single primitives as long as ranges are large. So it touches each primitive
// only a few times. This is after Garanzha, Pantaleoni and McAllister 2011, "Simpler and faster HLBVH with
// work queues", whose clusters are runs of equal Morton codes.
#pragma once

#include <span>
#include <vector>

#include "raytrace/bvh/bins.h"

namespace gnomon::raytrace::binned {

/// Holds the primitives of one cell, or one that is far longer than a cell: order[first, first + count).
struct Cluster {
  std::uint32_t first, count;
};

struct Clusters {
  HugeArray<std::uint32_t> order;  ///< places of the boxes in what was sorted
  std::vector<Cluster> clusters;
  std::vector<Ref> boxes;  ///< of the clusters, each with its number as its id
  std::size_t size() const { return clusters.size(); }
};

/// In fact from BoxRef or Ref. The same for any number of threads.
Clusters cluster_by_cells(std::span<const BoxRef> boxes, const Box& centroids);
Clusters cluster_by_cells(std::span<const Ref> refs, const Box& centroids);

/// The centroids' bounds, doubled as always here.
Box centroid_bounds(std::span<const BoxRef> boxes);

/// Whether a grid would tell any of them apart.
bool grid_applies(const Box& centroids);

}  // namespace gnomon::raytrace::binned
