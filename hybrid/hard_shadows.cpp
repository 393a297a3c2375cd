#include "hybrid/hard_shadows.h"

#include <tbb/enumerable_thread_specific.h>

#include "raytrace/tiles.h"
#include "scene/timing.h"

namespace gnomon::hybrid {
namespace {

using raytrace::SurfacePoint;
using raytrace::Verdict;

class Tile {
 public:
  Tile(const LightCache& cache, const Image<SurfacePoint>& receivers, const raytrace::TileRect& rect)
      : cache_(cache), receivers_(receivers), rect_(rect) {}

  ShadowCounts classify(Image<Verdict>& verdicts, Image<Decision>* decisions) {
    prefetch_next();
    ShadowCounts counts;
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) {
        const SurfacePoint& point = receivers_.at(x, y);
        const Decision decision = decide(point);
        // What is to be traced counts as lit until it is.
        verdicts.at(x, y) =
            point.primitive != no_id && decision != Decision::lit && decision != Decision::traced
                ? Verdict::shadowed
                : Verdict::lit;
        if (decisions != nullptr) decisions->at(x, y) = decision;
        count(decision, counts);
        if (decision == Decision::traced) ask(x - rect_.x0, y - rect_.y0);
      }
    return counts;
  }

  const raytrace::LaneMask& unsure() const { return unsure_; }

 private:
  /// The next tile's receivers come from memory while these are classified.
  void prefetch_next() const {
    if (rect_.x1 + raytrace::tile_pixels > receivers_.size.width) return;
    for (int y = rect_.y0; y < rect_.y1; ++y) {
      const char* row = reinterpret_cast<const char*>(&receivers_.at(rect_.x1, y));
      for (std::size_t byte = 0; byte < raytrace::tile_pixels * sizeof(SurfacePoint); byte += 64)
        __builtin_prefetch(row + byte);
    }
  }
  Decision decide(const SurfacePoint& point) const {
    if (point.primitive == no_id || light_cannot_reach(cache_.light, point.position, point.normal))
      return Decision::not_asked;
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
  static void count(Decision decision, ShadowCounts& counts) {
    counts.asked += decision != Decision::not_asked ? 1 : 0;
    counts.lit += decision == Decision::lit ? 1 : 0;
    counts.shadowed += decision == Decision::shadowed ? 1 : 0;
    counts.rays += decision == Decision::traced ? 1 : 0;
  }
  void ask(int x, int y) {
    const std::size_t lane = raytrace::tile_lane(x, y);
    unsure_[lane / raytrace::packet_rays] |= static_cast<std::uint16_t>(1U << (lane % raytrace::packet_rays));
  }

  const LightCache& cache_;
  const Image<SurfacePoint>& receivers_;
  raytrace::TileRect rect_;
  raytrace::LaneMask unsure_{};
};

}  // namespace

LightCache::LightCache(const raytrace::Tracer& tracer, const raytrace::Topology& topology,
                       const Light& its_light, const LightView& view)
    : light(its_light), sheets(tracer.world(), topology, view) {
  const Stopwatch watch;
  const raytrace::Structures& structures = tracer.structures();
  if (packets_apply(structures)) {
    seen = seen_from(structures, light);
    seen_bytes = structures.bvh.primitives.size() * sizeof(raytrace::SeenPrimitive);
  }
  build_ms = sheets.stats().build_ms + watch.elapsed_ms();
}

namespace {

ShadowCounts sum_of(const std::vector<ShadowCounts>& tiles) {
  ShadowCounts sum;
  for (const ShadowCounts& tile : tiles) {
    sum.asked += tile.asked, sum.lit += tile.lit;
    sum.shadowed += tile.shadowed, sum.rays += tile.rays;
  }
  return sum;
}

/// The texels that receivers without an answer look up.
std::vector<std::uint64_t> texels_in_doubt(const LightSheets& sheets, const Image<SurfacePoint>& receivers,
                                           const std::vector<raytrace::LaneMask>& unsure) {
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> found;
  for_each_tile(raytrace::TileGrid{receivers.size}, [&](std::size_t i, int x0, int y0, int, int) {
    for (std::size_t lane = 0; lane < raytrace::tile_rays; ++lane) {
      if ((unsure[i][lane / raytrace::packet_rays] >> (lane % raytrace::packet_rays) & 1) == 0) continue;
      const auto [dx, dy] = raytrace::tile_place(lane);
      const auto texel = sheets.texel_of(receivers.at(x0 + dx, y0 + dy).position);
      if (texel) found.local().push_back(*texel);
    }
  });
  std::vector<std::uint64_t> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

ShadowCounts trace_hard_shadows(const raytrace::Tracer& tracer, LightCache& cache,
                                const Image<SurfacePoint>& receivers, Image<Verdict>& verdicts,
                                Image<Decision>* decisions) {
  if (!(verdicts.size == receivers.size)) verdicts = Image<Verdict>(receivers.size);
  const raytrace::TileGrid grid{receivers.size};
  std::vector<ShadowCounts> tiles(grid.count());
  std::vector<raytrace::LaneMask> unsure(grid.count());
  const auto classify = [&] {
    for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      Tile tile(cache, receivers, {x0, y0, x1, y1});
      tiles[i] = tile.classify(verdicts, decisions);
      unsure[i] = tile.unsure();
    });
    return sum_of(tiles);
  };
  ShadowCounts counts = classify();
  if (static_cast<double>(counts.rays) > refine_above * static_cast<double>(counts.asked)) {
    if (cache.sheets.refine(texels_in_doubt(cache.sheets, receivers, unsure)) > 0) counts = classify();
  }
  for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    if (tiles[i].rays > 0)
      raytrace::shadow_lanes(tracer, cache.light, cache.seen, {x0, y0, x1, y1}, unsure[i], receivers,
                             verdicts);
  });
  return counts;
}

}  // namespace gnomon::hybrid
