// The plane of (u, v) in bins, and for each bin the primitives that its rays may intersect, nearest first:
// rays with a common origin or direction need no hierarchy then, each reads the list of its own bin until
// what is left lies behind it. Filled conservatively: whatever a ray of a bin does not surely miss is in its
// list. Bins cost one look at every primitive; where rays are few, the hierarchy is cheaper (bins_pay). This is
// the light buffer of Haines and Greenberg 1986, "The light buffer: a shadow-testing accelerator", made for each
// frame over what the frame's rays may hit, as Hunt and Mark 2008 do in "Ray-specialized acceleration structures
// for ray tracing".
#pragma once

#include <limits>
#include <vector>

#include "raytrace/packets/edge_setup.h"

namespace gnomon::raytrace {

/// One axis of the plane: `count` steps of equal width, some of them to a bin. A step holds the rays between
/// lo + i * width and hi + i * width: a pixel's centre alone, or a bin's whole width and a little more.
struct BinAxis {
  double lo = 0.0, hi = 0.0, width = 1.0;
  int count = 1, per_bin = 1;
  float origin = 0.0f, per_width = 1.0f;  ///< a ray's step is (u - origin) * per_width, rounded down
  int bins() const { return (count + per_bin - 1) / per_bin; }
};

/// Beyond these values of u or v there is nothing finite: rays there intersect planes alone.
struct PlaneLimits {
  float u_min = -std::numeric_limits<float>::infinity(), u_max = -u_min;
  float v_min = u_min, v_max = u_max;
};

/// Where in its bin a primitive's bounds lie: u_min, u_max, v_min, v_max in 256ths, from the lowest byte on.
using BoxInBin = std::uint32_t;

struct LightBins {
  BinAxis u, v;
  PlaneLimits limits;                ///< a light's; what the bins leave out may lie beyond
  std::vector<std::uint32_t> first;  ///< of each bin, row by row; and the end
  /// The lists, in the order of falling `nearest`: the primitive is surely behind rays in this bin whose far
  /// is above it. Padded by packet_rays.
  HugeArray<float> nearest;
  HugeArray<std::uint32_t> leaf;
  HugeArray<BoxInBin> box;
  HugeArray<PrimitiveEdges> primitives;  ///< in leaf order; those in no list are not written

  int columns() const { return u.bins(); }
  int rows() const { return v.bins(); }
  std::size_t bytes() const {
    return first.size() * sizeof(first[0]) + nearest.bytes() + leaf.bytes() + box.bytes() +
           primitives.bytes();
  }
};

/// Whether bins are the cheaper way for so many rays.
bool bins_pay(const Structures& structures, std::size_t rays);

/// Fills the lists; false when too many primitives have no bounds in the plane for that to be worth while.
bool fill_light_bins(const Structures& structures, const EdgeSetup& setup, LightBins& bins);

}  // namespace gnomon::raytrace
