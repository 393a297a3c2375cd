#include "raytrace/packet/cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>

#include "raytrace/packet/cell_cover.h"
#include "raytrace/packet/seen_rows.h"

namespace gnomon::raytrace {
namespace {

/// Primitives without bounds are tried at every cell: more such tests than this are not worth while.
constexpr std::size_t most_tries = std::size_t{1} << 26;

/// Bounds, lines and rays are floats.
double slack_of(const CellAxis& axis) {
  return 0x1p-21 * std::max(std::abs(axis.lo), std::abs(axis.hi + axis.count * axis.width));
}

CellLines lines_of(const CellAxis& axis) {
  CellLines lines;
  const int cells = axis.cells();
  lines.lo.resize(static_cast<std::size_t>(cells) + packet_rays), lines.hi.resize(lines.lo.size());
  for (int i = 0; i < cells; ++i) {
    const int first = i * axis.per_cell, last = std::min(first + axis.per_cell, axis.count) - 1;
    const auto at = static_cast<std::size_t>(i);
    lines.lo[at] = static_cast<float>(axis.lo + first * axis.width - slack_of(axis));
    lines.hi[at] = static_cast<float>(axis.hi + last * axis.width + slack_of(axis));
  }
  return lines;
}

/// The first and the last cell whose rays may lie between two values; first > last: none.
class CellRange {
 public:
  explicit CellRange(const CellAxis& axis)
      : axis_(axis), slack_(slack_of(axis)), per_width_(1.0 / axis.width) {}
  void operator()(float low, float high, int& first, int& last) const {
    const double a = (static_cast<double>(low) - axis_.hi - slack_) * per_width_;
    const double b = (static_cast<double>(high) - axis_.lo + slack_) * per_width_;
    const int begin = a <= 0.0 ? 0 : a >= axis_.count ? axis_.count : static_cast<int>(std::ceil(a));
    const int end = b < 0.0 ? -1 : b >= axis_.count ? axis_.count - 1 : static_cast<int>(b);
    first = begin <= end ? begin / axis_.per_cell : 1, last = begin <= end ? end / axis_.per_cell : 0;
  }

 private:
  const CellAxis& axis_;
  double slack_, per_width_;
};

/// A primitive's bounds along an axis in 256ths of a cell, one of them added on either side for rounding.
struct Fine {
  std::int64_t low, high;
  Fine(const CellAxis& axis, float min, float max) {
    const double per = 256.0 / (axis.width * axis.per_cell), far = 256.0 * (axis.cells() + 1);
    const double start = 0.5 * (axis.lo + axis.hi - axis.width * (axis.per_cell == 1 ? 1.0 : 0.0));
    low = static_cast<std::int64_t>(
              std::floor(std::clamp((static_cast<double>(min) - start) * per, -far, far))) -
          1;
    high = static_cast<std::int64_t>(
               std::ceil(std::clamp((static_cast<double>(max) - start) * per, -far, far))) +
           1;
  }
  std::uint32_t in(int cell) const {
    const std::int64_t from = 256 * static_cast<std::int64_t>(cell);
    const auto a = static_cast<std::uint32_t>(std::clamp<std::int64_t>(low - from, 0, 255));
    const auto b = static_cast<std::uint32_t>(std::clamp<std::int64_t>(high - from, 0, 255));
    return a | b << 8;
  }
};

/// A share of the leaves: what it covers, and how much in every cell.
struct Share {
  std::vector<CoveredCell> covered;
  std::vector<std::uint32_t> counts;
  std::size_t tries = 0;
};

class Filler {
 public:
  Filler(const Structures& s, const Seen& seen, Cells& cells)
      : s_(s),
        pass_(seen_pass(s, seen)),
        cells_(cells),
        columns_(lines_of(cells.u)),
        rows_(lines_of(cells.v)),
        shares_(std::clamp<std::size_t>(2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
                                        1, 16)) {
    pass_.bounds = true;
  }

  bool run() {
    const std::size_t blocks = (s_.bvh.primitives.size() + 7) / 8;
    cells_.primitives = HugeArray<SeenPrimitive>(s_.bvh.primitives.size());
    const std::size_t n = shares_.size();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, 1),
        [&](const auto& r) {
          for (std::size_t i = r.begin(); i < r.end(); ++i)
            cover(blocks * i / n, blocks * (i + 1) / n, shares_[i]);
        },
        tbb::simple_partitioner());
    for (const Share& share : shares_)
      if (share.tries > most_tries / n) return false;
    make_room();
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) { scatter(shares_[i]); });
    sort_lists();
    return true;
  }

 private:
  void cover(std::size_t begin, std::size_t end, Share& share) {
    share.counts.assign(cell_count(), 0);
    share.covered.reserve(12 * (end - begin) + 1024);
    const CellRange in_u(cells_.u), in_v(cells_.v);
    SeenBlock block;
    for (std::size_t b = begin; b < end && share.tries <= most_tries / shares_.size(); ++b) {
      see_block(s_, pass_, 8 * b, block);
      const std::size_t count = std::min<std::size_t>(8, s_.bvh.primitives.size() - 8 * b);
      for (std::size_t i = 0; i < count; ++i) {
        const SeenBounds& bounds = block.bounds[i];
        CellRect rect;
        in_u(bounds.u_min, bounds.u_max, rect.x0, rect.x1);
        in_v(bounds.v_min, bounds.v_max, rect.y0, rect.y1);
        if (rect.x0 > rect.x1 || rect.y0 > rect.y1) continue;
        const auto leaf = static_cast<std::uint32_t>(8 * b + i);
        cells_.primitives[leaf] = block.primitive[i];
        add(block.primitive[i], leaf, bounds, rect, share);
      }
    }
  }

  void add(const SeenPrimitive& primitive, std::uint32_t leaf, const SeenBounds& bounds, const CellRect& rect,
           Share& share) {
    const auto area =
        static_cast<std::size_t>(rect.x1 - rect.x0 + 1) * static_cast<std::size_t>(rect.y1 - rect.y0 + 1);
    const Fine u(cells_.u, bounds.u_min, bounds.u_max), v(cells_.v, bounds.v_min, bounds.v_max);
    const auto columns = static_cast<std::uint32_t>(cells_.columns());
    if (area == 1) {
      const auto cell = static_cast<std::uint32_t>(rect.y0) * columns + static_cast<std::uint32_t>(rect.x0);
      share.covered.push_back({cell, leaf, bounds.nearest, u.in(rect.x0) | v.in(rect.y0) << 16});
      ++share.counts[cell];
      return;
    }
    if (bounds.u_min < -max_float) share.tries += area;
    const std::size_t old = share.covered.size();
    share.covered.resize(old + area + packet_rays);
    const std::size_t count =
        cover_cells(primitive, leaf, bounds.nearest, columns_, rows_, rect, share.covered.data() + old);
    share.covered.resize(old + count);
    for (std::size_t i = old; i < old + count; ++i) {
      CoveredCell& c = share.covered[i];
      ++share.counts[c.cell];
      c.box = u.in(static_cast<int>(c.cell % columns)) | v.in(static_cast<int>(c.cell / columns)) << 16;
    }
  }

  // Lists in the order of cells; in each the shares in turn. Afterwards a share's counts are its places.
  void make_room() {
    cells_.first.resize(cell_count() + 1);
    std::uint32_t sum = 0;
    for (std::size_t cell = 0; cell < cell_count(); ++cell) {
      cells_.first[cell] = sum;
      for (Share& share : shares_) sum += std::exchange(share.counts[cell], sum);
    }
    cells_.first.back() = sum;
    refs_ = HugeArray<CoveredCell>(sum);
  }

  void scatter(Share& share) {
    for (const CoveredCell& c : share.covered) refs_[share.counts[c.cell]++] = c;
    share.covered = {};
  }

  // Nearest first; the leaf decides between equals, so that any number of shares gives the same lists.
  void sort_lists() {
    const std::size_t padded = refs_.size() + packet_rays;
    cells_.nearest = HugeArray<float>(padded), cells_.leaf = HugeArray<std::uint32_t>(padded);
    cells_.box = HugeArray<PlaceInCell>(padded);
    for (std::size_t i = refs_.size(); i < padded; ++i)
      cells_.nearest[i] = 0.0f, cells_.leaf[i] = 0, cells_.box[i] = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cell_count(), 1024), [&](const auto& r) {
      for (std::size_t i = r.begin(); i < r.end(); ++i) sort_list(cells_.first[i], cells_.first[i + 1]);
    });
  }

  void sort_list(std::size_t begin, std::size_t end) {
    std::sort(refs_.data() + begin, refs_.data() + end, [](const CoveredCell& a, const CoveredCell& b) {
      return a.nearest != b.nearest ? a.nearest > b.nearest : a.leaf < b.leaf;
    });
    for (std::size_t i = begin; i < end; ++i) {
      const CoveredCell& ref = refs_[i];
      cells_.nearest[i] = ref.nearest, cells_.leaf[i] = ref.leaf, cells_.box[i] = ref.box;
    }
  }

  std::size_t cell_count() const {
    return static_cast<std::size_t>(cells_.columns()) * static_cast<std::size_t>(cells_.rows());
  }

  static constexpr float max_float = std::numeric_limits<float>::max();
  const Structures& s_;
  SeenPass pass_;
  Cells& cells_;
  CellLines columns_, rows_;
  std::vector<Share> shares_;
  HugeArray<CoveredCell> refs_;
};

}  // namespace

bool cells_pay(const Structures& s, std::size_t rays) {
  return rays >= s.bvh.primitives.size() / 4;
}

bool fill_cells(const Structures& s, const Seen& seen, Cells& cells) {
  return Filler(s, seen, cells).run();
}

}  // namespace gnomon::raytrace
