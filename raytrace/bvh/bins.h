// The bins of the hierarchy's builder (raytrace/bvh/bvh.cpp): boxes are rows of four floats. They are split
// by the surface-area heuristic (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies").
// All three axes are binned in one pass.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "raytrace/bvh/build_config.h"
#include "raytrace/bvh/bvh.h"
#include "raytrace/bvh/float4.h"

namespace gnomon::raytrace::binned {

inline constexpr std::size_t most_bins = BuildConfig::most_bins;

/// Four floats, the last of which means nothing here.
struct alignas(16) Row {
  float at[4];
  float& operator[](std::size_t i) { return at[i]; }
  float operator[](std::size_t i) const { return at[i]; }
  Float4 all() const { return Float4::load(at); }
};
inline void lower(Row& a, const Row& b) {
  min_keep(b.all(), a.all()).store(a.at);
}
inline void raise(Row& a, const Row& b) {
  max_keep(b.all(), a.all()).store(a.at);
}

struct alignas(16) Box {
  Row min, max;
  static Box empty() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return {{{inf, inf, inf, inf}}, {{-inf, -inf, -inf, -inf}}};
  }
  void grow(const Box& b) { lower(min, b.min), raise(max, b.max); }
  float half_area() const {
    const float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
  }
};

inline float largest_extent(const Box& box) {
  return std::max({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
}

struct alignas(16) Ref {
  Box box;
  std::uint32_t id() const { return std::bit_cast<std::uint32_t>(box.min[3]); }
  // Twice the centroid: halving would only lose the smallest numbers.
  Row centroid2() const {
    Row sum;
    (box.min.all() + box.max.all()).store(sum.at);
    return sum;
  }
};

/// Rows are stored whole: a processor waits when what it loads whole was stored float by float.
inline Ref ref_of(const BoxRef& b) {
  Ref ref;
  Float4::of(b.min[0], b.min[1], b.min[2], std::bit_cast<float>(b.id)).store(ref.box.min.at);
  Float4::of(b.max[0], b.max[1], b.max[2], 0.0f).store(ref.box.max.at);
  return ref;
}

inline const Ref& as_ref(const Ref& ref) {
  return ref;
}
inline Ref as_ref(const BoxRef& box) {
  return ref_of(box);
}

/// Holds the box of a range of primitives and that of their centroids, doubled.
struct NodeBounds {
  Box box = Box::empty(), centroids = Box::empty();
  void grow_centroids(const Ref& ref) {
    const Row c = ref.centroid2();
    lower(centroids.min, c), raise(centroids.max, c);
  }
  void grow(const Ref& ref) { box.grow(ref.box), grow_centroids(ref); }
  void grow(const NodeBounds& b) { box.grow(b.box), centroids.grow(b.centroids); }
};

struct Split {
  std::size_t axis = 0;
  int bin = -1;  // primitives of bins <= bin go left; -1: none found
  float cost = std::numeric_limits<float>::infinity();
};

/// Which bin of each axis a primitive falls into. An axis without extent, too wide for a float, or along
/// which centroids spread less than `flat` times the most is not binned: scale 0.
struct Binning {
  Row origin, scale;
  std::size_t count, axes = 0;
  std::array<std::uint8_t, 3> axis{};  ///< those that are binned
  Binning(const Box& centroids, std::size_t bins, float flat) : origin(centroids.min), scale{}, count(bins) {
    const float least = flat * largest_extent(centroids);
    for (std::size_t a = 0; a < 3; ++a) {
      const float extent = centroids.max[a] - centroids.min[a];
      const float per = extent > 0.0f && extent >= least ? static_cast<float>(bins) / extent : 0.0f;
      scale[a] = std::isfinite(per) && std::isfinite(extent) ? per : 0.0f;
      if (scale[a] > 0.0f) axis[axes++] = static_cast<std::uint8_t>(a);
    }
    origin[3] = 0.0f;
  }
  void operator()(const Ref& ref, std::int32_t* bin) const {
    const Float4 b = (ref.centroid2().all() - origin.all()) * scale.all();
    // What is not a number, as in the last place, becomes 0.
    store_truncated(min_keep(max_keep(b, Float4::all(0.0f)), Float4::all(static_cast<float>(count - 1))),
                    bin);
  }
  /// Whether its bin along the split's axis is one of the left ones.
  bool is_left(const Ref& ref, const Split& split) const {
    const std::size_t a = split.axis;
    const float b = (ref.box.min[a] + ref.box.max[a] - origin[a]) * scale[a];
    return !(b >= static_cast<float>(split.bin + 1));
  }
};

struct Bins {
  std::array<std::array<Box, most_bins>, 3> box;
  std::array<std::array<std::uint32_t, most_bins>, 3> count;
  explicit Bins(const Binning& binning) {
    for (std::size_t k = 0; k < binning.axes; ++k)
      for (std::size_t a = binning.axis[k], b = 0; b < binning.count; ++b)
        box[a][b] = Box::empty(), count[a][b] = 0;
  }
  /// `weight`: of how many primitives it is the box.
  void put(const Ref& ref, const Binning& binning, std::uint32_t weight = 1) {
    alignas(16) std::int32_t bin[4];
    binning(ref, bin);
    for (std::size_t k = 0; k < binning.axes; ++k) {
      const std::size_t a = binning.axis[k];
      const auto b = static_cast<std::size_t>(bin[a]);
      box[a][b].grow(ref.box), count[a][b] += weight;
    }
  }
};

/// The boxes of the two sides of a split.
inline std::array<Box, 2> boxes_of(const Bins& bins, std::size_t used, const Split& split) {
  std::array<Box, 2> sides = {Box::empty(), Box::empty()};
  for (std::size_t b = 0; b < used; ++b)
    sides[static_cast<int>(b) <= split.bin ? 0 : 1].grow(bins.box[split.axis][b]);
  return sides;
}

/// Reorders by goes_left(ref), keeping the order on both sides, and finds the bounds of their centroids on
/// the way. `scratch`: room for as many. Returns how many went left.
template <class GoesLeft>
std::uint32_t partition(std::span<Ref> refs, Ref* scratch, std::array<NodeBounds, 2>& bounds,
                        const GoesLeft& goes_left) {
  std::size_t left = 0, right = 0;
  for (std::size_t i = 0; i < refs.size(); ++i) {
    const Ref ref = refs[i];
    const std::size_t is_left = goes_left(ref) ? 1 : 0;
    bounds[1 - is_left].grow_centroids(ref);
    refs[left] = ref, scratch[right] = ref;
    left += is_left, right += 1 - is_left;
  }
  std::copy(scratch, scratch + right, refs.begin() + static_cast<std::ptrdiff_t>(left));
  return static_cast<std::uint32_t>(left);
}

/// The bins of a range; weight(ref): of how many primitives it is the box.
template <class Weight>
Bins fill_bins(std::span<const Ref> refs, const Binning& binning, const Weight& weight) {
  Bins bins(binning);
  for (const Ref& ref : refs) bins.put(ref, binning, weight(ref));
  return bins;
}

/// The cheaper one of `best` and the cheapest split along the axis.
inline Split best_on_axis(const Bins& bins, std::size_t used, std::size_t axis, Split best) {
  std::array<float, most_bins> right_cost{};
  Box box = Box::empty();
  std::uint32_t count = 0;
  for (std::size_t b = used - 1; b > 0; --b) {
    box.grow(bins.box[axis][b]), count += bins.count[axis][b];
    right_cost[b - 1] =
        count == 0 ? std::numeric_limits<float>::infinity() : box.half_area() * static_cast<float>(count);
  }
  box = Box::empty(), count = 0;
  for (std::size_t b = 0; b + 1 < used; ++b) {
    box.grow(bins.box[axis][b]), count += bins.count[axis][b];
    if (count == 0) continue;
    const float cost = box.half_area() * static_cast<float>(count) + right_cost[b];
    if (cost < best.cost) best = {axis, static_cast<int>(b), cost};
  }
  return best;
}

/// The cheapest split between two bins by the surface-area heuristic; bin -1: no axis tells the centroids apart.
inline Split find_best_split(const Bins& bins, const Binning& binning) {
  Split best;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (binning.scale[axis] > 0.0f) best = best_on_axis(bins, binning.count, axis, best);
  return best;
}

}  // namespace gnomon::raytrace::binned
