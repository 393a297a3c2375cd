#include "raytrace/packets/shadow_pass.h"

#include <cstring>
#include <optional>

#include "raytrace/packets/light_setup.h"
#include "raytrace/packets/shadow_block.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

/// Below this many rays a block's traversal costs more than single rays.
constexpr std::uint64_t few_rays = 12;

/// Eight pixels' visibility from eight bits: a byte of 1, lit, for every bit that is not set.
constexpr auto eight_visibilities = [] {
  static_assert(static_cast<int>(PointVisibility::shadowed) == 0 &&
                static_cast<int>(PointVisibility::lit) == 1);
  std::array<std::array<PointVisibility, 8>, 256> table{};
  for (std::size_t dark = 0; dark < table.size(); ++dark)
    for (std::size_t i = 0; i < 8; ++i)
      table[dark][i] = (dark >> i & 1) != 0 ? PointVisibility::shadowed : PointVisibility::lit;
  return table;
}();

std::uint64_t number_of(const LaneMask& bits) {
  std::array<std::uint64_t, sizeof(LaneMask) / sizeof(std::uint64_t)> words;
  std::memcpy(words.data(), bits.data(), sizeof bits);
  std::uint64_t sum = 0;
  for (const std::uint64_t word : words) sum += static_cast<std::uint64_t>(std::popcount(word));
  return sum;
}

/// One tile on its way from receivers to visibility.
struct Tile {
  TileRays rays;
  ShadowLanes lanes;
  TileShadows shadows;
  TileRect rect;
  ReceiverSource source;
  const QuantisedTile* quantised;
  LaneMask asked;
};

/// A light's pass; `asked`: by tile, empty: everything.
class ShadowPass {
 public:
  ShadowPass(const PictureReceivers& receivers, const Light& light, std::span<const LaneMask> asked,
             Image<PointVisibility>& visibility)
      : receivers_(receivers), light_(light), asked_(asked), visibility_(visibility) {}

  ShadowRayCounts run(const std::stop_token& stop) {
    PerThread<Scratch> scratch;
    for_each_block(receivers_.size, stop, [&](const BlockRect& rect) { run_block(rect, scratch.local()); });
    ShadowRayCounts rays;
    for (const Scratch& part : scratch) rays += part.rays;
    return rays;
  }

 private:
  /// The light as a block's receivers see it.
  struct LightFrame {
    EdgeSetup setup;
    std::optional<PlaneLimits> limits;  ///< where there is but one plane
  };
  struct Scratch {
    HugeArray<Tile> tiles{most_shadow_tiles};
    HugeArray<SurfacePoint> points{tile_rays};
    LastBlocker blocker;  ///< of a single ray
    ShadowRayCounts rays;
  };

  void run_block(const BlockRect& rect, Scratch& scratch) const {
    std::size_t count = 0;
    Aabb bounds;
    for_each_tile_of(rect, [&](std::size_t, const TileRect& tile) {
      if (begin(tile, scratch.tiles[count], bounds)) ++count;
    });
    if (count == 0) return;
    const std::span<Tile> tiles(scratch.tiles.data(), count);
    if (tiles[0].quantised != nullptr) prefetch(tiles[0].quantised);
    const LightFrame frame = frame_of(bounds);
    std::uint64_t rays = 0;
    std::array<ShadowTileRays, most_shadow_tiles> in_block;
    for (std::size_t t = 0; t < count; ++t) {
      rays += prepare(frame.setup, tiles[t], t + 1 < count ? tiles[t + 1].quantised : nullptr);
      in_block[t] = {&tiles[t].rays, &tiles[t].shadows};
    }
    scratch.rays.cast += rays;
    const bool at_any_cost = receivers_.packets == PacketUse::always;
    if (receivers_.packets == PacketUse::never || (rays <= few_rays && !at_any_cost))
      for (Tile& tile : tiles) leave_to_single_rays(tile);
    else
      shadows_in_block(receivers_.tracer.structures(), frame.setup, {in_block.data(), count}, at_any_cost);
    for (const Tile& tile : tiles) finish(frame, tile, scratch);
  }

  LightFrame frame_of(const Aabb& bounds) const {
    const Structures& s = receivers_.tracer.structures();
    LightFrame frame{edge_setup_of_light(receivers_.tracer, light_, bounds), std::nullopt};
    if (s.planes.size() == 1) frame.limits = limits_of(s, frame.setup);
    return frame;
  }

  /// False when nothing is asked of the tile.
  bool begin(const TileRect& rect, Tile& tile, Aabb& bounds) const {
    const std::size_t at = tile_at(receivers_.size, rect);
    tile.rect = rect;
    tile.quantised = receivers_.quantised.empty() ? nullptr : &receivers_.quantised[at];
    tile.asked = asked_.empty() ? every_lane : asked_[at];
    tile.source = {.tracer = &receivers_.tracer,
                   .stored = receivers_.stored,
                   .view = receivers_.view,
                   .hits = receivers_.hits.empty() ? nullptr : &receivers_.hits[at],
                   .first_row = receivers_.first_row};
    bool any = false;
    if (tile.quantised != nullptr) {
      any = tile.quantised->any;
      if (any && tile.asked != LaneMask{}) bounds.grow(tile.quantised->bounds);
    } else {
      for_each_place(rect, tile.asked, [&](int x, int y, std::size_t) {
        const SurfacePoint& point = receivers_.stored->at(x, y);
        if (point.primitive != no_id) any = true, bounds.grow(point.position);
      });
    }
    if (!any && asked_.empty()) store_visibility(rect, {}, visibility_);
    return any && tile.asked != LaneMask{};
  }

  /// Returns the number of rays. `next`: the tile that comes next, or null.
  std::uint64_t prepare(const EdgeSetup& setup, Tile& tile, const QuantisedTile* next) const {
    const bool reached = !asked_.empty();  // the light is known to reach all that is asked for
    if (tile.quantised != nullptr && (reached || light_.type != LightType::spot) &&
        quantisation_applies(setup, *tile.quantised)) {
      prepare_quantised(light_, setup, *tile.quantised, next, tile.asked, tile.rays, tile.lanes);
      if (!reached) decide_grazing(tile);
    } else {
      prepare_one_by_one(setup, tile);
    }
    if (reached)  // what floats hold to be facing away is asked in double
      for (std::size_t p = 0; p < tile_packets; ++p) {
        tile.rays.alive[p] &= tile.asked[p];
        tile.lanes.apart[p] = static_cast<std::uint16_t>(tile.asked[p] & ~tile.rays.alive[p]);
      }
    if (receivers_.tracer.structures().has_non_receivers) leave_out_non_receivers(tile);
    LaneMask traced;
    for (std::size_t p = 0; p < tile_packets; ++p) traced[p] = tile.rays.alive[p] | tile.lanes.apart[p];
    return number_of(traced);
  }

  /// They are lit, and no ray is cast for them.
  void leave_out_non_receivers(Tile& tile) const {
    const World& world = receivers_.tracer.world();
    for_each_place(tile.rect, [&](int, int, std::size_t lane) {
      const bool has_ray = has_lane(tile.rays.alive, lane) || has_lane(tile.lanes.apart, lane);
      if (!has_ray || world.receives_shadow(tile.rays.source[lane])) return;
      const auto others = static_cast<std::uint16_t>(~(1u << (lane % packet_rays)));
      tile.rays.alive[lane / packet_rays] &= others, tile.lanes.apart[lane / packet_rays] &= others;
    });
  }

  /// Whether floats from the tile's origin are near enough to its receivers.
  static bool quantisation_applies(const EdgeSetup& setup, const QuantisedTile& tile) {
    const Vec3 largest = glm::max(glm::abs(tile.bounds.min), glm::abs(tile.bounds.max));
    return max_component(largest) < setup.reach && (!setup.directional || tile.extent < setup.lateral);
  }

  void prepare_one_by_one(const EdgeSetup& setup, Tile& tile) const {
    TileRays& rays = tile.rays;
    rays.alive.fill(0);
    for (std::size_t i = 0; i < tile_rays; ++i)
      rays.u[i] = rays.v[i] = rays.far[i] = 0.0f, rays.source[i] = no_id;
    tile.lanes.apart.fill(0), tile.lanes.unreached.fill(0), tile.lanes.grazing.fill(0);
    for_each_place(tile.rect, [&](int, int, std::size_t lane) {
      const SurfacePoint point = tile.source.at(tile.rect, lane);
      if (point.primitive == no_id) return;
      rays.source[lane] = point.primitive;
      const bool reached = !light_cannot_reach(light_, point.position, point.normal);
      auto& bits = !reached                            ? tile.lanes.unreached
                   : project(setup, point, rays, lane) ? rays.alive
                                                       : tile.lanes.apart;
      add_lane(bits, lane);
    });
  }

  /// False when the frame cannot hold the ray.
  static bool project(const EdgeSetup& setup, const SurfacePoint& point, TileRays& rays, std::size_t lane) {
    if (!(max_component(glm::abs(point.position)) < setup.reach)) return false;
    const Vec3 offset = point.position - setup.origin;
    double u = glm::dot(offset, setup.axes[0]), v = glm::dot(offset, setup.axes[1]);
    double far = glm::dot(offset, setup.axes[2]);
    if (setup.directional) {
      if (!(std::abs(u) < setup.lateral && std::abs(v) < setup.lateral && std::abs(far) < setup.height))
        return false;
    } else {
      const double depth = far;
      far = 1.0 / depth, u *= far, v *= far;
      if (!(depth > 0x1p-30 * setup.reach && std::abs(u) < widest_slope && std::abs(v) < widest_slope))
        return false;
    }
    rays.u[lane] = static_cast<float>(u), rays.v[lane] = static_cast<float>(v);
    rays.far[lane] = static_cast<float>(far);
    return true;
  }

  void decide_grazing(Tile& tile) const {
    for_each_place(tile.rect, tile.lanes.grazing, [&](int, int, std::size_t lane) {
      const SurfacePoint point = tile.source.at(tile.rect, lane);
      if (!light_cannot_reach(light_, point.position, point.normal)) return;
      const std::size_t p = lane / packet_rays;
      const auto bit = static_cast<std::uint16_t>(1u << (lane % packet_rays));
      const auto others = static_cast<std::uint16_t>(~bit);
      tile.rays.alive[p] &= others, tile.lanes.apart[p] &= others, tile.lanes.unreached[p] |= bit;
    });
  }

  static void leave_to_single_rays(Tile& tile) {
    for (std::size_t p = 0; p < tile_packets; ++p) tile.lanes.apart[p] |= tile.rays.alive[p];
    tile.shadows.shadowed.fill(0), tile.shadows.ambiguous.fill(0), tile.shadows.ambiguous_count = 0;
  }

  void finish(const LightFrame& frame, const Tile& tile, Scratch& scratch) const {
    if (asked_.empty()) {
      LaneMask dark;
      for (std::size_t p = 0; p < tile_packets; ++p)
        dark[p] = tile.shadows.shadowed[p] | tile.lanes.unreached[p];
      store_visibility(tile.rect, dark, visibility_);
    } else {
      for_each_place(tile.rect, tile.asked, [&](int x, int y, std::size_t lane) {
        const bool dark = has_lane(tile.shadows.shadowed, lane);
        visibility_.at(x, y) = dark ? PointVisibility::shadowed : PointVisibility::lit;
      });
    }
    decide_rest(frame, tile, scratch);
  }

  void decide_rest(const LightFrame& frame, const Tile& tile, Scratch& scratch) const {
    LaneMask left;
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] = tile.shadows.ambiguous[p] | tile.lanes.apart[p];
    if (left == LaneMask{}) return;
    SurfacePoint* points = scratch.points.data();
    tile.source.fill(tile.rect, left, points);
    const bool listed = tile.shadows.ambiguous_count <= TileShadows::most_ambiguous;
    for_each_place(tile.rect, left, [&](int x, int y, std::size_t lane) {
      const SurfacePoint& point =
          points[static_cast<std::size_t>(tile_pixels * (y - tile.rect.y0) + x - tile.rect.x0)];
      const bool in_list = listed && !has_lane(tile.lanes.apart, lane);
      scratch.rays.single += in_list ? 0 : 1;
      visibility_.at(x, y) = in_list ? visibility_among(tile.shadows, point, lane)
                                     : full_visibility(frame, point, scratch.blocker);
    });
  }

  PointVisibility full_visibility(const LightFrame& frame, const SurfacePoint& point,
                                  LastBlocker& last) const {
    return is_beyond_all(frame, point) ? PointVisibility::lit
                                       : receivers_.tracer.centre_visibility(point, light_, &last);
  }

  /// The receiver lies on the only plane there is, and its ray beyond all that is finite: nothing shadows it.
  bool is_beyond_all(const LightFrame& frame, const SurfacePoint& receiver) const {
    if (!frame.limits || receiver.primitive != receivers_.tracer.structures().planes.front()) return false;
    double u = 0.0, v = 0.0;
    return project_point(frame.setup, receiver.position, u, v) && !frame.limits->hold(u, v);
  }

  PointVisibility visibility_among(const TileShadows& shadows, const SurfacePoint& point,
                                   std::size_t lane) const {
    std::array<std::uint32_t, TileShadows::most_ambiguous> leaves;
    std::size_t count = 0;
    for (std::size_t i = 0; i < shadows.ambiguous_count; ++i)
      if (shadows.ambiguous_hits[i].lane == lane) leaves[count++] = shadows.ambiguous_hits[i].leaf;
    return receivers_.tracer.centre_visibility_among(point, light_, {leaves.data(), count});
  }

  const PictureReceivers& receivers_;
  const Light& light_;
  std::span<const LaneMask> asked_;
  Image<PointVisibility>& visibility_;
};

}  // namespace

void store_visibility(const TileRect& rect, const LaneMask& dark, Image<PointVisibility>& visibility) {
  if (rect.is_whole()) {
    const auto stride = static_cast<std::size_t>(visibility.size.width);
    PointVisibility* first = &visibility.at(rect.x0, rect.y0);
    for (std::size_t y = 0; y < tile_pixels; ++y) {
      // Of each of four packets side by side four bits: sixteen pixels of a row.
      const std::uint16_t* packets = &dark[y / 4 * 4];
      const auto four = [&](std::size_t column) { return packets[column] >> y % 4 * 4 & 15U; };
      for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t bits = four(2 * half) | four(2 * half + 1) << 4;
        std::memcpy(first + y * stride + 8 * half, eight_visibilities[bits].data(), 8);
      }
    }
    return;
  }
  for_each_place(rect, [&](int x, int y, std::size_t lane) {
    visibility.at(x, y) = has_lane(dark, lane) ? PointVisibility::shadowed : PointVisibility::lit;
  });
}

ShadowRayCounts shadow_pass(const PictureReceivers& receivers, const Light& light,
                            Image<PointVisibility>& visibility, const std::stop_token& stop) {
  return ShadowPass(receivers, light, {}, visibility).run(stop);
}

void shadow_pass_of(const PictureReceivers& receivers, const Light& light, std::span<const LaneMask> asked,
                    Image<PointVisibility>& visibility) {
  ShadowPass(receivers, light, asked, visibility).run({});
}

}  // namespace gnomon::raytrace
