// Shadow rays of a tile: raytrace/packets/passes.h.
#include <cstring>

#include "raytrace/packets/bin_shadows.h"
#include "raytrace/packets/known_hit.h"
#include "raytrace/packets/passes.h"
#include "raytrace/packets/places.h"
#include "raytrace/packets/prepare.h"
#include "raytrace/packets/unstored.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

bool start(const EdgeSetup& setup, const SurfacePoint& point, TileRays& rays, std::size_t lane) {
  if (!(max_component(glm::abs(point.position)) < setup.reach)) return false;
  const Vec3 offset = point.position - setup.origin;
  const auto k = static_cast<std::size_t>(setup.directional ? 2 : rays.axis);
  double u = glm::dot(offset, setup.axes[(k + 1) % 3]), v = glm::dot(offset, setup.axes[(k + 2) % 3]);
  double far = glm::dot(offset, setup.axes[k]);
  if (setup.directional) {
    if (!(std::abs(u) < setup.lateral && std::abs(v) < setup.lateral && std::abs(far) < setup.height))
      return false;
  } else {
    const double depth = static_cast<double>(rays.sign) * far;
    far = 1.0 / depth, u *= far, v *= far;
    if (!(depth > 0x1p-30 * setup.reach && std::abs(u) < widest_slope && std::abs(v) < widest_slope))
      return false;
  }
  rays.u[lane] = static_cast<float>(u), rays.v[lane] = static_cast<float>(v);
  rays.far[lane] = static_cast<float>(far);
  return true;
}

void choose_axis(const EdgeSetup& setup, const Vec3& receiver, TileRays& rays) {
  rays.axis = 2, rays.sign = 1.0f;
  if (setup.directional || setup.framed) return;
  const Vec3 offset = receiver - setup.origin;
  rays.axis = longest_axis(offset);
  rays.sign = offset[rays.axis] < 0.0 ? -1.0f : 1.0f;
}

/// Whether floats from the tile's origin are near enough to its receivers.
bool quantisation_applies(const EdgeSetup& setup, const QuantisedTile& tile) {
  const Vec3 largest = glm::max(glm::abs(tile.bounds.min), glm::abs(tile.bounds.max));
  return max_component(largest) < setup.reach && (!setup.directional || tile.extent < setup.lateral);
}

/// Four pixels' verdicts from four bits: a byte of 1, lit, for every bit that is not set.
constexpr auto four_visibilities = [] {
  static_assert(static_cast<int>(Verdict::shadowed) == 0 && static_cast<int>(Verdict::lit) == 1);
  std::array<std::array<Verdict, 4>, 16> table{};
  for (std::size_t dark = 0; dark < 16; ++dark)
    for (std::size_t i = 0; i < 4; ++i)
      table[dark][i] = (dark >> i & 1) != 0 ? Verdict::shadowed : Verdict::lit;
  return table;
}();

/// Below this many rays a tile's traversal of the hierarchy costs more than single rays.
constexpr int few_rays = 6;

std::uint64_t number_of(const LaneMask& bits) {
  std::array<std::uint64_t, sizeof(LaneMask) / sizeof(std::uint64_t)> words;
  std::memcpy(words.data(), bits.data(), sizeof bits);
  std::uint64_t sum = 0;
  for (const std::uint64_t word : words) sum += static_cast<std::uint64_t>(std::popcount(word));
  return sum;
}

/// One tile on its way from receivers to verdicts.
class ShadowTile {
 public:
  ShadowTile(const ReceiverSource& receivers, const Light& light, const Sight& sight, const TileRect& rect)
      : receivers_(receivers), light_(light), sight_(sight), rect_(rect) {}

  std::uint64_t run(const QuantisedTile* quantised, Image<Verdict>& verdicts) {
    for (int y = rect_.y0; y < rect_.y1; ++y) __builtin_prefetch(&verdicts.at(rect_.x0, y), 1);
    prepare(quantised, every_lane, false);
    if (quantised != nullptr) prefetch(quantised + 1);
    trace();
    LaneMask dark, traced;
    for (std::size_t p = 0; p < tile_packets; ++p) {
      dark[p] = shadows_.shadowed[p] | lanes_.unreached[p];
      traced[p] = rays_.alive[p] | lanes_.apart[p];
    }
    const std::uint64_t count = number_of(traced);
    store_verdicts(rect_, dark, verdicts);
    decide_rest(verdicts);
    return count;
  }

  /// Of asked receivers that the light reaches.
  void run_lanes(const QuantisedTile* quantised, const LaneMask& asked, Image<Verdict>& verdicts) {
    prepare(quantised, asked, true);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      // What floats hold to be facing away is asked in double.
      rays_.alive[p] &= asked[p];
      lanes_.apart[p] = static_cast<std::uint16_t>(asked[p] & ~rays_.alive[p]);
    }
    trace();
    for_each_place(rect_, asked, [&](int x, int y, std::size_t lane) {
      const bool dark = (shadows_.shadowed[lane / packet_rays] & bit_of(lane)) != 0;
      verdicts.at(x, y) = dark ? Verdict::shadowed : Verdict::lit;
    });
    decide_rest(verdicts);
  }

 private:
  /// The next tile comes from memory while this one is traced. Beyond the last one nothing is read.
  static void prefetch(const QuantisedTile* next) {
    const char* bytes = reinterpret_cast<const char*>(next);
    for (std::size_t i = 0; i < sizeof(QuantisedTile); i += 64) __builtin_prefetch(bytes + i);
  }

  void trace() {
    if (sight_.by_bins)
      shadows_in_bins(sight_.bins, sight_.setup, rays_, shadows_, outside_);
    else
      shadows_in_tile(receivers_.tracer.structures().bvh, sight_.setup, rays_, shadows_);
  }

  /// reached: the light is known to reach all that is asked for.
  void prepare(const QuantisedTile* quantised, const LaneMask& asked, bool reached) {
    const EdgeSetup& setup = sight_.setup;
    if (quantised != nullptr && (reached || light_.type != LightType::spot) &&
        quantisation_applies(setup, *quantised)) {
      choose_axis(setup, quantised->origin, rays_);
      prepare_quantised(light_, setup, *quantised, asked, rays_, lanes_);
      if (!reached) decide_grazing();
      return;
    }
    if (receivers_.stored != nullptr && is_whole(rect_) && light_.type != LightType::spot && !setup.framed) {
      const Image<SurfacePoint>& stored = *receivers_.stored;
      choose_axis(setup, some_receiver(), rays_);
      prepare_shadows(light_, setup, &stored.at(rect_.x0, rect_.y0),
                      static_cast<std::size_t>(stored.size.width), rays_, lanes_);
    } else {
      choose_axis(setup, some_receiver(), rays_);
      prepare_one_by_one();
    }
  }

  void prepare_one_by_one() {
    rays_.alive.fill(0);
    for (std::size_t i = 0; i < tile_rays; ++i)
      rays_.u[i] = rays_.v[i] = rays_.far[i] = 0.0f, rays_.source[i] = no_id;
    lanes_.apart.fill(0), lanes_.unreached.fill(0), lanes_.grazing.fill(0);
    for_each_place(rect_, [&](int, int, std::size_t lane) {
      const SurfacePoint point = receivers_.at(rect_, lane);
      if (point.primitive == no_id) return;
      rays_.source[lane] = point.primitive;
      const bool reached = !light_cannot_reach(light_, point.position, point.normal);
      auto& bits = !reached                                  ? lanes_.unreached
                   : start(sight_.setup, point, rays_, lane) ? rays_.alive
                                                             : lanes_.apart;
      bits[lane / packet_rays] |= bit_of(lane);
    });
  }

  /// The tile's middle receiver, or the first one where there is none.
  Vec3 some_receiver() const {
    SurfacePoint point =
        receivers_.at(rect_, tile_lane((rect_.x1 - rect_.x0) / 2, (rect_.y1 - rect_.y0) / 2));
    for_each_place(rect_, [&](int, int, std::size_t lane) {
      if (point.primitive == no_id) point = receivers_.at(rect_, lane);
    });
    return point.position;
  }

  void decide_grazing() {
    for_each_place(rect_, lanes_.grazing, [&](int, int, std::size_t lane) {
      const SurfacePoint point = receivers_.at(rect_, lane);
      if (!light_cannot_reach(light_, point.position, point.normal)) return;
      const std::size_t p = lane / packet_rays;
      const auto others = static_cast<std::uint16_t>(~bit_of(lane));
      rays_.alive[p] &= others, lanes_.apart[p] &= others, lanes_.unreached[p] |= bit_of(lane);
    });
  }

  void decide_rest(Image<Verdict>& verdicts) {
    LaneMask asked;
    for (std::size_t p = 0; p < tile_packets; ++p) asked[p] = shadows_.ambiguous[p] | lanes_.apart[p];
    if (asked == LaneMask{}) return;
    HugeArray<SurfacePoint> points(tile_rays);
    receivers_.fill(rect_, asked, points.data());
    const bool listed = shadows_.ambiguous_count <= TileShadows::most_ambiguous;
    for_each_place(rect_, asked, [&](int x, int y, std::size_t lane) {
      const SurfacePoint& point =
          points[static_cast<std::size_t>(tile_pixels * (y - rect_.y0) + x - rect_.x0)];
      const std::size_t p = lane / packet_rays;
      const bool in_list = listed && ((outside_[p] | lanes_.apart[p]) & bit_of(lane)) == 0;
      verdicts.at(x, y) = in_list ? visibility_among(point, lane) : full_visibility(point);
    });
  }

  Verdict full_visibility(const SurfacePoint& point) const {
    if (is_beyond_all(receivers_.tracer.structures(), sight_, point)) return Verdict::lit;
    return receivers_.tracer.light_verdict(point, light_);
  }

  Verdict visibility_among(const SurfacePoint& point, std::size_t lane) const {
    std::array<std::uint32_t, TileShadows::most_ambiguous> leaves;
    std::size_t count = 0;
    for (std::size_t i = 0; i < shadows_.ambiguous_count; ++i)
      if (shadows_.ambiguous_hits[i].lane == lane) leaves[count++] = shadows_.ambiguous_hits[i].leaf;
    return receivers_.tracer.light_verdict_among(point, light_, {leaves.data(), count});
  }

  const ReceiverSource& receivers_;
  const Light& light_;
  const Sight& sight_;
  const TileRect& rect_;
  TileRays rays_;
  ShadowLanes lanes_;
  TileShadows shadows_;
  LaneMask outside_{};
};

}  // namespace

void store_verdicts(const TileRect& rect, const LaneMask& dark, Image<Verdict>& verdicts) {
  if (is_whole(rect)) {
    const auto stride = static_cast<std::size_t>(verdicts.size.width);
    for (std::size_t p = 0; p < tile_packets; ++p) {
      const TilePixel place = tile_pixel(p * packet_rays);
      Verdict* out = &verdicts.at(rect.x0 + place.x, rect.y0 + place.y);
      for (std::size_t row = 0; row < 4; ++row)
        std::memcpy(out + row * stride, four_visibilities[dark[p] >> (4 * row) & 15].data(), 4);
    }
    return;
  }
  for_each_place(rect, [&](int x, int y, std::size_t lane) {
    verdicts.at(x, y) = (dark[lane / packet_rays] & bit_of(lane)) != 0 ? Verdict::shadowed : Verdict::lit;
  });
}

std::uint64_t shadow_tile(const ReceiverSource& receivers, const Light& light, const Sight& sight,
                          const TileRect& rect, const QuantisedTile* quantised, Image<Verdict>& verdicts) {
  if (quantised != nullptr && !quantised->any) {
    store_verdicts(rect, {}, verdicts);
    return 0;
  }
  return ShadowTile(receivers, light, sight, rect).run(quantised, verdicts);
}

void shadow_lanes(const ReceiverSource& receivers, const Light& light, const Sight* sight,
                  const TileRect& rect, const QuantisedTile* quantised, const LaneMask& asked,
                  Image<Verdict>& verdicts) {
  int count = 0;
  for (const std::uint16_t bits : asked) count += std::popcount(bits);
  if (sight == nullptr || (!sight->by_bins && count <= few_rays)) {
    for_each_place(rect, asked, [&](int x, int y, std::size_t lane) {
      verdicts.at(x, y) = receivers.tracer.light_verdict(receivers.at(rect, lane), light);
    });
    return;
  }
  ShadowTile(receivers, light, *sight, rect).run_lanes(quantised, asked, verdicts);
}

}  // namespace gnomon::raytrace
