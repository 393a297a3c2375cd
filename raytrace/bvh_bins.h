// The bins of the hierarchy's builder (raytrace/bvh.cpp): boxes as rows of four floats, and where to split
// them by the surface-area heuristic (Wald 2007, "On fast construction of SAH-based bounding volume
// hierarchies"). All three axes are binned in one pass.
#pragma once

#include <bit>
#include <limits>

#include "raytrace/bvh.h"

namespace gnomon::raytrace::binned {

inline constexpr std::size_t most_bins = 16, few_bins = 8;  ///< few: where there are few to put in

/// Four floats, the last of which means nothing here: loops over them become single instructions.
using Row = std::array<float, 4>;
inline void lower(Row& a, const Row& b) {
  for (std::size_t i = 0; i < 4; ++i) a[i] = b[i] < a[i] ? b[i] : a[i];
}
inline void raise(Row& a, const Row& b) {
  for (std::size_t i = 0; i < 4; ++i) a[i] = b[i] > a[i] ? b[i] : a[i];
}

struct alignas(16) Box {
  Row min, max;
  static Box empty() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return {{inf, inf, inf, inf}, {-inf, -inf, -inf, -inf}};
  }
  void grow(const Box& b) { lower(min, b.min), raise(max, b.max); }
  float half_area() const {
    const float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
  }
};

struct alignas(16) Ref {
  Box box;
  std::uint32_t id() const { return std::bit_cast<std::uint32_t>(box.min[3]); }
  // Twice the centroid: halving would only lose the smallest numbers.
  Row centroid2() const {
    Row sum;
    for (std::size_t i = 0; i < 4; ++i) sum[i] = box.min[i] + box.max[i];
    return sum;
  }
};

inline Ref ref_of(const BoxRef& b) {
  return {{{b.min[0], b.min[1], b.min[2], std::bit_cast<float>(b.id)}, {b.max[0], b.max[1], b.max[2], 0.0f}}};
}

/// Of a range of primitives: their box and that of their centroids, doubled.
struct Bounds {
  Box box = Box::empty(), centroids = Box::empty();
  void grow(const Ref& ref) {
    const Row c = ref.centroid2();
    box.grow(ref.box), lower(centroids.min, c), raise(centroids.max, c);
  }
  void grow(const Bounds& b) { box.grow(b.box), centroids.grow(b.centroids); }
};

struct Split {
  std::size_t axis = 0;
  int bin = -1;  // primitives of bins <= bin go left; -1: none found
  float cost = std::numeric_limits<float>::infinity();
};

/// Which bin of each axis a primitive falls into. An axis without extent (or too wide for a float) cannot be
/// binned: scale 0.
struct Binning {
  Row origin, scale;
  std::size_t count;
  Binning(const Box& centroids, std::size_t bins) : origin(centroids.min), scale{}, count(bins) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float extent = centroids.max[a] - centroids.min[a];
      const float per = extent > 0.0f ? static_cast<float>(bins) / extent : 0.0f;
      scale[a] = std::isfinite(per) && std::isfinite(extent) ? per : 0.0f;
    }
    origin[3] = 0.0f;
  }
  std::array<std::int32_t, 4> operator()(const Ref& ref) const {
    const Row c = ref.centroid2();
    const auto last = static_cast<float>(count - 1);
    std::array<std::int32_t, 4> bin;
    for (std::size_t i = 0; i < 4; ++i) {
      const float b = (c[i] - origin[i]) * scale[i];
      const float above = b > 0.0f ? b : 0.0f;  // what is not a number, as in the last place, too
      bin[i] = static_cast<std::int32_t>(above < last ? above : last);
    }
    return bin;
  }
};

struct Bins {
  std::array<std::array<Box, most_bins>, 3> box;
  std::array<std::array<std::uint32_t, most_bins>, 3> count;
  explicit Bins(std::size_t used) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < used; ++b) box[a][b] = Box::empty(), count[a][b] = 0;
  }
  void put(const Ref& ref, const std::array<std::int32_t, 4>& bin) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto b = static_cast<std::size_t>(bin[a]);
      box[a][b].grow(ref.box), ++count[a][b];
    }
  }
  void join(const Bins& other, std::size_t used) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < used; ++b)
        box[a][b].grow(other.box[a][b]), count[a][b] += other.count[a][b];
  }
};

inline void best_on_axis(const Bins& bins, std::size_t used, std::size_t axis, Split& best) {
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
}

}  // namespace gnomon::raytrace::binned
