#include "hybrid/hard_shadows.h"

#include <tbb/enumerable_thread_specific.h>

#include <bit>
#include <cstring>

#include "hybrid/classify.h"
#include "raytrace/tiles.h"

namespace gnomon::hybrid {
namespace {

using raytrace::CompactTile;
using raytrace::packet_rays;
using raytrace::SurfacePoint;
using raytrace::tile_packets;
using raytrace::TileRect;
using raytrace::Verdict;

/// lane(x, y, lane) for every set bit.
template <class Lane>
void for_each_lane(const TileRect& rect, const LaneBits& bits, const Lane& each) {
  for (std::size_t p = 0; p < tile_packets; ++p)
    for (unsigned left = bits[p]; left != 0; left &= left - 1) {
      const std::size_t lane = p * packet_rays + static_cast<std::size_t>(std::countr_zero(left));
      const raytrace::TilePlace at = raytrace::tile_place(lane);
      each(rect.x0 + at.x, rect.y0 + at.y, lane);
    }
}

void put(LaneBits& bits, std::size_t lane) {
  bits[lane / packet_rays] |= static_cast<std::uint16_t>(1u << (lane % packet_rays));
}

/// One tile of the picture on its way from receivers to decisions.
class Tile {
 public:
  Tile(const LightCache& cache, const Receivers& receivers, std::size_t index, const TileRect& rect)
      : cache_(cache), receivers_(receivers), compact_(receivers.tiles[index]), rect_(rect) {}

  ShadowCounts classify(Image<Verdict>& verdicts, Image<Decision>* decisions) {
    prefetch(&compact_ + 1);
    if (!compact_.any) {
      fill(verdicts, Verdict::lit);
      if (decisions != nullptr) fill(*decisions, Decision::not_asked);
      return {};
    }
    if (cache_.light.type == LightType::spot)
      all_.open = compact_.present;
    else
      classify_tile(cache_.sheets, cache_.light, compact_, all_);
    for_each_lane(rect_, all_.open, [&](int x, int y, std::size_t lane) {
      put(bits_of(decide(receivers_.points.at(x, y))), lane);
    });
    store(verdicts);
    if (decisions != nullptr) store_decisions(*decisions);
    return counts();
  }

  const LaneBits& unsure() const { return all_.unsure; }

 private:
  /// The next tile comes from memory while this one is classified. Beyond the last one nothing is read.
  static void prefetch(const CompactTile* next) {
    const char* bytes = reinterpret_cast<const char*>(next);
    for (std::size_t i = 0; i < sizeof(CompactTile); i += 64) __builtin_prefetch(bytes + i);
  }

  Decision decide(const SurfacePoint& point) const {
    if (light_cannot_reach(cache_.light, point.position, point.normal)) return Decision::not_asked;
    switch (cache_.sheets.at(point.position, point.primitive)) {
      case Certainty::lit:
        return Decision::lit;
      case Certainty::shadowed:
        return Decision::shadowed;
      case Certainty::unsure:
        break;
    }
    return Decision::traced;
  }
  LaneBits& bits_of(Decision decision) {
    switch (decision) {
      case Decision::shadowed:
        return all_.shadowed;
      case Decision::lit:
        return all_.lit;
      case Decision::traced:
        return all_.unsure;
      case Decision::not_asked:
        break;
    }
    return all_.unreached;
  }

  template <class T>
  void fill(Image<T>& image, T value) const {
    for (int y = rect_.y0; y < rect_.y1; ++y) std::fill_n(&image.at(rect_.x0, y), rect_.x1 - rect_.x0, value);
  }

  // Lit where there is no receiver; what is to be traced counts as lit until it is.
  void store(Image<Verdict>& verdicts) const {
    LaneBits dark;
    for (std::size_t p = 0; p < tile_packets; ++p)
      dark[p] = static_cast<std::uint16_t>(all_.shadowed[p] | all_.unreached[p]);
    raytrace::store_verdicts(rect_, dark, verdicts);
  }
  void store_decisions(Image<Decision>& decisions) const {
    fill(decisions, Decision::not_asked);
    const auto set = [&](const LaneBits& bits, Decision decision) {
      for_each_lane(rect_, bits, [&](int x, int y, std::size_t) { decisions.at(x, y) = decision; });
    };
    set(all_.lit, Decision::lit), set(all_.shadowed, Decision::shadowed);
    set(all_.unsure, Decision::traced);
  }
  ShadowCounts counts() const {
    ShadowCounts counts;
    const auto add = [](const LaneBits& bits, std::uint64_t& count) {
      std::array<std::uint64_t, sizeof bits / sizeof(std::uint64_t)> words;
      std::memcpy(words.data(), bits.data(), sizeof words);
      for (const std::uint64_t word : words) count += static_cast<std::uint64_t>(std::popcount(word));
    };
    add(all_.lit, counts.lit), add(all_.shadowed, counts.shadowed), add(all_.unsure, counts.rays);
    counts.asked = counts.lit + counts.shadowed + counts.rays;
    return counts;
  }

  const LightCache& cache_;
  const Receivers& receivers_;
  const CompactTile& compact_;
  TileRect rect_;
  TileClasses all_{};
};

ShadowCounts sum_of(const std::vector<ShadowCounts>& tiles) {
  ShadowCounts sum;
  for (const ShadowCounts& tile : tiles) {
    sum.asked += tile.asked, sum.lit += tile.lit;
    sum.shadowed += tile.shadowed, sum.rays += tile.rays;
  }
  return sum;
}

/// The parts of texels that receivers without an answer look up.
std::vector<std::uint64_t> parts_in_doubt(const LightSheets& sheets, const Image<SurfacePoint>& receivers,
                                          const std::vector<LaneBits>& unsure) {
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> found;
  for_each_tile(raytrace::TileGrid{receivers.size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    for_each_lane({x0, y0, x1, y1}, unsure[i], [&](int x, int y, std::size_t) {
      const auto part = sheets.part_of(receivers.at(x, y).position);
      if (part) found.local().push_back(*part);
    });
  });
  std::vector<std::uint64_t> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

double share_of_rays(const ShadowCounts& counts) {
  return static_cast<double>(counts.rays) / static_cast<double>(std::max<std::uint64_t>(counts.asked, 1));
}

/// For packets of rays from these receivers; null where packets do not apply.
const raytrace::Sight* find_sight(const raytrace::Tracer& tracer, LightCache& cache,
                                  const Receivers& receivers) {
  const raytrace::Structures& s = tracer.structures();
  if (!packets_apply(s)) return nullptr;
  if (!cache.sight || !covers(*cache.sight, receivers.compact()))
    cache.sight = sight_of_light(s, cache.light, receivers.compact());
  return &*cache.sight;
}

}  // namespace

LightCache::LightCache(const raytrace::Tracer& tracer, const raytrace::Topology& topology,
                       const Light& its_light, const LightView& view)
    : light(its_light), sheets(tracer.world(), topology, view), build_ms(sheets.stats().build_ms) {}

std::uint64_t LightCache::bytes() const {
  std::uint64_t bytes = sheets.stats().bytes;
  if (sight) bytes += sight->seen.primitives.bytes() + sight->cells.bytes();
  return bytes;
}

ShadowCounts trace_hard_shadows(const raytrace::Tracer& tracer, LightCache& cache, const Receivers& receivers,
                                Image<Verdict>& verdicts, Image<Decision>* decisions) {
  if (!(verdicts.size == receivers.points.size)) verdicts = Image<Verdict>(receivers.points.size);
  const raytrace::TileGrid grid{receivers.points.size};
  std::vector<ShadowCounts> tiles(grid.count());
  std::vector<LaneBits> unsure(grid.count());
  const raytrace::Sight* sight = find_sight(tracer, cache, receivers);
  const raytrace::ReceiverSource source{.tracer = tracer, .stored = &receivers.points};
  const auto pass = [&] {
    for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      const TileRect rect{x0, y0, x1, y1};
      Tile tile(cache, receivers, i, rect);
      tiles[i] = tile.classify(verdicts, decisions);
      unsure[i] = tile.unsure();
      if (tiles[i].rays > 0)
        shadow_lanes(source, cache.light, sight, rect, &receivers.tiles[i], unsure[i], verdicts);
    });
    return sum_of(tiles);
  };
  ShadowCounts counts = pass();
  if (share_of_rays(counts) > std::max(refine_above, 1.25 * cache.share_left)) {
    if (cache.sheets.refine(parts_in_doubt(cache.sheets, receivers.points, unsure)) > 0) counts = pass();
    cache.share_left = share_of_rays(counts);
  }
  return counts;
}

}  // namespace gnomon::hybrid
