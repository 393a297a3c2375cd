#include "raytrace/packets/light_bins.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "raytrace/packets/bin_cover.h"
#include "raytrace/packets/edge_setup_rows.h"

namespace gnomon::raytrace {
namespace {

/// Primitives without bounds are tried at every bin: more such tests than this are not worth while.
constexpr std::size_t most_tries = std::size_t{1} << 26;

/// Bounds, lines and rays are floats.
double slack_of(const BinAxis& axis) {
  return 0x1p-21 * std::max(std::abs(axis.lo), std::abs(axis.hi + axis.count * axis.width));
}

BinLines lines_of(const BinAxis& axis) {
  BinLines lines;
  const int bins = axis.bins();
  lines.lo.resize(static_cast<std::size_t>(bins) + packet_rays), lines.hi.resize(lines.lo.size());
  for (int i = 0; i < bins; ++i) {
    const int first = i * axis.per_bin, last = std::min(first + axis.per_bin, axis.count) - 1;
    const auto at = static_cast<std::size_t>(i);
    lines.lo[at] = static_cast<float>(axis.lo + first * axis.width - slack_of(axis));
    lines.hi[at] = static_cast<float>(axis.hi + last * axis.width + slack_of(axis));
  }
  return lines;
}

/// A share of the leaves: what it covers, and how much in every bin.
struct Share {
  HugeVector<CoveredBin> covered;
  std::size_t used = 0;  // of `covered`
  std::vector<std::uint32_t> counts;
  std::size_t tries = 0;

  /// Room for `more` at the end.
  CoveredBin* reserve(std::size_t more) {
    if (used + more > covered.size())
      covered.resize(std::max(used + more, covered.size() + covered.size() / 2));
    return covered.data() + used;
  }
};

/// Nearest first; the leaf decides between equals, so that any number of shares gives the same lists.
class ListSorter {
 public:
  explicit ListSorter(LightBins& bins) : bins_(bins) {}

  void sort(std::size_t begin, std::size_t end) {
    if (end - begin <= few) return insert(begin, end);
    const std::size_t count = end - begin;
    if (nearest_.size() < count + packet_rays)
      nearest_.resize(count + packet_rays), others_.resize(count), rank_.resize(count + packet_rays);
    for (std::size_t i = 0; i < count; ++i)
      nearest_[i] = bins_.nearest[begin + i], others_[i] = {bins_.leaf[begin + i], bins_.box[begin + i]};
    if (count <= many)
      rank_falling(nearest_.data(), count, rank_.data());
    else
      rank_many(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = begin + rank_[i];
      bins_.nearest[at] = nearest_[i], bins_.leaf[at] = others_[i].leaf, bins_.box[at] = others_[i].box;
    }
  }

 private:
  struct Others {
    std::uint32_t leaf;
    BoxInBin box;
  };

  void insert(std::size_t begin, std::size_t end) {
    float* nearest = bins_.nearest.data();
    std::uint32_t* leaf = bins_.leaf.data();
    BoxInBin* box = bins_.box.data();
    for (std::size_t i = begin + 1; i < end; ++i) {
      const float key = nearest[i];
      const Others others{leaf[i], box[i]};
      std::size_t at = i;
      for (; at > begin && nearest[at - 1] < key; --at)
        nearest[at] = nearest[at - 1], leaf[at] = leaf[at - 1], box[at] = box[at - 1];
      nearest[at] = key, leaf[at] = others.leaf, box[at] = others.box;
    }
  }

  void rank_many(std::size_t count) {
    order_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) order_[i] = std::uint64_t{falling(nearest_[i])} << 32 | i;
    std::sort(order_.begin(), order_.end());
    for (std::uint32_t i = 0; i < count; ++i) rank_[static_cast<std::uint32_t>(order_[i])] = i;
  }
  /// In the order of falling numbers.
  static std::uint32_t falling(float number) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    return (bits & 0x80000000u) != 0 ? bits : ~bits & 0x7fffffffu;
  }

  // Up to `few` vectors do not pay; above `many` comparing each with each does not.
  static constexpr std::size_t few = 10, many = 384;
  LightBins& bins_;
  std::vector<float> nearest_;
  std::vector<Others> others_;
  std::vector<std::uint32_t> rank_;
  std::vector<std::uint64_t> order_;
};

class BinFiller {
 public:
  BinFiller(const Structures& s, const EdgeSetup& setup, LightBins& bins)
      : s_(s),
        pass_(edge_setup_pass(s, setup)),
        bins_(bins),
        columns_(lines_of(bins.u)),
        rows_(lines_of(bins.v)),
        width_(static_cast<std::uint32_t>(bins.columns())),
        shares_(std::clamp<std::size_t>(2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
                                        1, 16)) {
    pass_.bounds = true;
  }

  bool run() {
    const std::size_t blocks = (s_.bvh.primitives.size() + 7) / 8;
    bins_.primitives = HugeArray<PrimitiveEdges>(s_.bvh.primitives.size());
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
    make_lists();
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) { scatter(shares_[i]); });
    sort_lists();
    return true;
  }

 private:
  void cover(std::size_t begin, std::size_t end, Share& share) {
    share.counts.assign(bin_count(), 0);
    share.covered.resize(14 * (end - begin) + 1024);
    const double u_slack = slack_of(bins_.u), v_slack = slack_of(bins_.v);
    EdgeSetupBlock block;
    BinSpans u, v;
    for (std::size_t b = begin; b < end && share.tries <= most_tries / shares_.size(); ++b) {
      set_up_block(s_, pass_, 8 * b, block);
      place_eight(bins_.u, u_slack, block.u_min(), block.u_max(), u);
      place_eight(bins_.v, v_slack, block.v_min(), block.v_max(), v);
      for (std::size_t i = 0; i < 8; ++i) {
        const BinRect rect{u.first[i], v.first[i], u.last[i], v.last[i]};
        if (rect.x0 > rect.x1 || rect.y0 > rect.y1) continue;
        const auto leaf = static_cast<std::uint32_t>(8 * b + i);
        bins_.primitives[leaf] = primitive_in(s_, block, i, leaf);
        const std::size_t old = share.used;
        put_bins(block, i, leaf, rect, share);
        for (std::size_t k = old; k < share.used; ++k) {
          CoveredBin& c = share.covered[k];
          ++share.counts[c.bin];
          const std::uint32_t y = c.bin / width_;
          c.box = u.in(i, static_cast<int>(c.bin - y * width_)) | v.in(i, static_cast<int>(y)) << 16;
        }
      }
    }
  }

  void put_bins(const EdgeSetupBlock& block, std::size_t i, std::uint32_t leaf, const BinRect& rect,
                Share& share) {
    const int across = rect.x1 - rect.x0 + 1, down = rect.y1 - rect.y0 + 1;
    const auto width = static_cast<std::size_t>(across);
    const std::size_t area = width * static_cast<std::size_t>(down);
    CoveredBin* to = share.reserve(area + packet_rays);
    const float nearest = block.nearest()[i];
    if (area <= 2) {  // what reaches into both of two bins is hit in both
      const std::uint32_t bin =
          static_cast<std::uint32_t>(rect.y0) * width_ + static_cast<std::uint32_t>(rect.x0);
      to[0] = {bin, leaf, nearest, 0};
      to[1] = {bin + (width == 2 ? 1 : width_), leaf, nearest, 0};
      share.used += area;
      return;
    }
    if (block.u_min()[i] < -max_float) share.tries += area;
    share.used += cover_bins(bins_.primitives[leaf], leaf, nearest, columns_, rows_, rect, to);
  }

  // Lists in the order of bins; in each the shares in turn, and so the leaves ascend. Afterwards a share's
  // counts are its places.
  void make_lists() {
    bins_.first.resize(bin_count() + 1);
    std::uint32_t sum = 0;
    for (std::size_t bin = 0; bin < bin_count(); ++bin) {
      bins_.first[bin] = sum;
      for (Share& share : shares_) sum += std::exchange(share.counts[bin], sum);
    }
    bins_.first.back() = sum;
    const std::size_t padded = sum + packet_rays;
    bins_.nearest = HugeArray<float>(padded), bins_.leaf = HugeArray<std::uint32_t>(padded);
    bins_.box = HugeArray<BoxInBin>(padded);
    for (std::size_t i = sum; i < padded; ++i) bins_.nearest[i] = 0.0f, bins_.leaf[i] = 0, bins_.box[i] = 0;
  }

  void scatter(Share& share) {
    for (std::size_t i = 0; i < share.used; ++i) {
      const CoveredBin& c = share.covered[i];
      const std::uint32_t at = share.counts[c.bin]++;
      bins_.nearest[at] = c.nearest, bins_.leaf[at] = c.leaf, bins_.box[at] = c.box;
    }
    share.covered = {};
  }

  void sort_lists() {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bin_count(), 512), [&](const auto& r) {
      ListSorter sorter(bins_);
      for (std::size_t i = r.begin(); i < r.end(); ++i) sorter.sort(bins_.first[i], bins_.first[i + 1]);
    });
  }

  std::size_t bin_count() const {
    return static_cast<std::size_t>(bins_.columns()) * static_cast<std::size_t>(bins_.rows());
  }

  static constexpr float max_float = std::numeric_limits<float>::max();
  const Structures& s_;
  EdgeSetupPass pass_;
  LightBins& bins_;
  BinLines columns_, rows_;
  std::uint32_t width_;  // bins in a row
  std::vector<Share> shares_;
};

}  // namespace

bool bins_pay(const Structures& s, std::size_t rays) {
  return rays >= s.bvh.primitives.size() / 4;
}

bool fill_light_bins(const Structures& s, const EdgeSetup& setup, LightBins& bins) {
  return BinFiller(s, setup, bins).run();
}

}  // namespace gnomon::raytrace
