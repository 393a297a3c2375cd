#include "hybrid/hard_shadows.h"

#include <bit>
#include <cstring>

#include "hybrid/light_sheets.h"
#include "scene/base/parallel.h"

namespace gnomon::hybrid {
namespace {

using raytrace::PointVisibility;
using raytrace::QuantisedTile;
using raytrace::Receivers;
using raytrace::SurfacePoint;
using raytrace::tile_packets;
using raytrace::TileRect;

/// One tile of the picture on its way from receivers to decisions.
class Tile {
 public:
  Tile(const LightCache& cache, const Receivers& receivers, std::size_t index, const TileRect& rect)
      : cache_(cache), receivers_(receivers), quantised_(receivers.tiles[index]), rect_(rect) {}

  ShadowCounts classify(Image<PointVisibility>& visibility, Image<Decision>* decisions) {
    prefetch(&quantised_ + 1);  // while this one is classified; beyond the last one nothing is read
    if (!quantised_.any) {
      fill(visibility, PointVisibility::lit);
      if (decisions != nullptr) fill(*decisions, Decision::not_asked);
      return {};
    }
    if (cache_.light.type == LightType::spot)
      all_.open = quantised_.present;
    else
      classify_tile(cache_.sheets, cache_.light, quantised_, all_);
    for_each_place(rect_, all_.open, [&](int x, int y, std::size_t lane) {
      raytrace::add_lane(bits_of(decide(receivers_.points.at(x, y))), lane);
    });
    store(visibility);
    if (decisions != nullptr) store_decisions(*decisions);
    return counts();
  }

  const LaneMask& ambiguous() const { return all_.ambiguous; }

 private:
  Decision decide(const SurfacePoint& point) const {
    if (light_cannot_reach(cache_.light, point.position, point.normal)) return Decision::not_asked;
    switch (cache_.sheets.at(point.position, point.primitive)) {
      case Certainty::lit:
        return Decision::lit;
      case Certainty::shadowed:
        return Decision::shadowed;
      case Certainty::ambiguous:
        break;
    }
    return Decision::traced;
  }
  LaneMask& bits_of(Decision decision) {
    switch (decision) {
      case Decision::shadowed:
        return all_.shadowed;
      case Decision::lit:
        return all_.lit;
      case Decision::traced:
        return all_.ambiguous;
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
  void store(Image<PointVisibility>& visibility) const {
    LaneMask dark;
    for (std::size_t p = 0; p < tile_packets; ++p)
      dark[p] = static_cast<std::uint16_t>(all_.shadowed[p] | all_.unreached[p]);
    raytrace::store_visibility(rect_, dark, visibility);
  }
  void store_decisions(Image<Decision>& decisions) const {
    fill(decisions, Decision::not_asked);
    const auto set = [&](const LaneMask& bits, Decision decision) {
      for_each_place(rect_, bits, [&](int x, int y, std::size_t) { decisions.at(x, y) = decision; });
    };
    set(all_.lit, Decision::lit), set(all_.shadowed, Decision::shadowed);
    set(all_.ambiguous, Decision::traced);
  }
  ShadowCounts counts() const {
    ShadowCounts counts;
    const auto add = [](const LaneMask& bits, std::uint64_t& count) {
      std::array<std::uint64_t, sizeof bits / sizeof(std::uint64_t)> words;
      std::memcpy(words.data(), bits.data(), sizeof words);
      for (const std::uint64_t word : words) count += static_cast<std::uint64_t>(std::popcount(word));
    };
    add(all_.lit, counts.lit), add(all_.shadowed, counts.shadowed), add(all_.ambiguous, counts.rays);
    counts.asked = counts.lit + counts.shadowed + counts.rays;
    return counts;
  }

  const LightCache& cache_;
  const Receivers& receivers_;
  const QuantisedTile& quantised_;
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
std::vector<std::uint64_t> ambiguous_parts(const LightSheets& sheets, const Image<SurfacePoint>& receivers,
                                           const std::vector<LaneMask>& ambiguous) {
  PerThread<std::vector<std::uint64_t>> found;
  for_each_tile(raytrace::TileGrid{receivers.size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    raytrace::for_each_place({x0, y0, x1, y1}, ambiguous[i], [&](int x, int y, std::size_t) {
      const auto part = sheets.part_of(receivers.at(x, y).position);
      if (part) found.local().push_back(*part);
    });
  });
  std::vector<std::uint64_t> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Fowler, Noll and Vo's, by words.
std::uint64_t hash_of(const std::vector<LaneMask>& tiles) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const LaneMask& tile : tiles) {
    std::array<std::uint64_t, sizeof(LaneMask) / sizeof(std::uint64_t)> words;
    std::memcpy(words.data(), tile.data(), sizeof tile);
    for (const std::uint64_t word : words) hash = (hash ^ word) * 0x100000001b3u;
  }
  return hash;
}

double share_of_rays(const ShadowCounts& counts) {
  return static_cast<double>(counts.rays) / static_cast<double>(std::max<std::uint64_t>(counts.asked, 1));
}

/// One light's pass over a picture.
class Pass {
 public:
  Pass(const raytrace::Tracer& tracer, LightCache& cache, const Receivers& receivers,
       Image<PointVisibility>& visibility, Image<Decision>* decisions)
      : tracer_(tracer),
        cache_(cache),
        receivers_(receivers),
        visibility_(visibility),
        decisions_(decisions),
        grid_{receivers.points.size},
        tiles_(grid_.count()),
        ambiguous_(grid_.count()) {}

  ShadowCounts run() {
    const bool pays = cache_.frames >= cache_.frames_to_pay(receivers_.points.data.size());
    if (!cache_.sheets.is_built() && pays) cache_.sheets.build();
    ++cache_.frames;
    if (!cache_.sheets.is_built() && cache_.sheets.lone_plane() == no_id && decisions_ == nullptr &&
        packets_apply(tracer_))
      return trace_all();
    ShadowCounts counts = classify();
    if (cache_.sheets.is_built()) refine(counts);
    if (counts.rays > 0) trace_shadows_of(tracer_, receivers_, cache_.light, ambiguous_, visibility_);
    return counts;
  }

 private:
  void refine(ShadowCounts& counts) {
    const std::uint64_t pattern = hash_of(ambiguous_);
    const bool pays = !cache_.pattern || *cache_.pattern == pattern;
    cache_.pattern = pattern;
    if (!pays || !(share_of_rays(counts) > std::max(refine_above, 1.25 * cache_.share_left))) return;
    if (cache_.sheets.refine(ambiguous_parts(cache_.sheets, receivers_.points, ambiguous_)) > 0)
      counts = classify();
    cache_.share_left = share_of_rays(counts);
    cache_.pattern = hash_of(ambiguous_);
  }
  ShadowCounts classify() {
    for_each_tile(grid_, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      Tile tile(cache_, receivers_, i, {x0, y0, x1, y1});
      tiles_[i] = tile.classify(visibility_, decisions_);
      ambiguous_[i] = tile.ambiguous();
    });
    return sum_of(tiles_);
  }
  /// Traces every shadow ray, as the pure tracer does.
  ShadowCounts trace_all() {
    ShadowCounts counts;
    counts.rays = counts.asked = trace_shadows(tracer_, receivers_, cache_.light, visibility_);
    return counts;
  }

  const raytrace::Tracer& tracer_;
  LightCache& cache_;
  const Receivers& receivers_;
  Image<PointVisibility>& visibility_;
  Image<Decision>* decisions_;
  raytrace::TileGrid grid_;
  std::vector<ShadowCounts> tiles_;
  std::vector<LaneMask> ambiguous_;
};

}  // namespace

LightCache::LightCache(const raytrace::Tracer& tracer, const raytrace::Topology& topology,
                       const Light& its_light, const LightView& view, Sheets when)
    : light(its_light), sheets(tracer.world(), topology, view), triangles_(tracer.world().triangle_count()) {
  if (when == Sheets::at_once) sheets.build();
}

// Measured per triangle and texel of the map, and per pixel that is classified instead of traced (Zen 5,
// one thread; the courtyard, the bunny and the armadillo at 1080p): only the ratio counts.
std::uint64_t LightCache::frames_to_pay(std::uint64_t pixels) const {
  constexpr std::uint64_t triangle_ns = 1000, texel_ns = 120, pixel_ns = 10;
  const auto size = static_cast<std::uint64_t>(sheets.view().size);
  const std::uint64_t texels = size * size * static_cast<std::uint64_t>(sheets.view().face_count);
  return (triangle_ns * triangles_ + texel_ns * texels) / std::max<std::uint64_t>(pixel_ns * pixels, 1);
}

std::uint64_t LightCache::bytes() const {
  return sheets.stats().bytes;
}

ShadowCounts trace_hard_shadows(const raytrace::Tracer& tracer, LightCache& cache, const Receivers& receivers,
                                Image<PointVisibility>& visibility, Image<Decision>* decisions) {
  if (!(visibility.size == receivers.points.size)) visibility = Image<PointVisibility>(receivers.points.size);
  return Pass(tracer, cache, receivers, visibility, decisions).run();
}

}  // namespace gnomon::hybrid
