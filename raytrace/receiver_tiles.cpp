#include "raytrace/receiver_tiles.h"

#include <numeric>

#include "raytrace/packets/known_hit.h"
#include "raytrace/packets/receivers.h"
#include "raytrace/packets/shadow_pass.h"

namespace gnomon::raytrace {
namespace {

std::vector<std::uint32_t> hit_places(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  std::vector<std::uint32_t> places(tracer.world().primitive_count(), nothing_hit);
  for (std::uint32_t i = 0; i < s.bvh.leaf_count(); ++i) places[s.bvh.id_at(i)] = i;
  for (std::uint32_t i = 0; i < s.planes.size(); ++i) places[s.planes[i]] = first_plane + i;
  return places;
}

PictureReceivers stored(const Tracer& tracer, const Receivers& receivers) {
  return {.tracer = tracer,
          .size = receivers.points.size,
          .stored = &receivers.points,
          .view = nullptr,
          .hits = {},
          .quantised = {receivers.tiles.data(), receivers.tiles.size()}};
}

}  // namespace

Receivers make_receivers(Image<SurfacePoint> points) {
  Receivers made{std::move(points), {}};
  const TileGrid grid{made.points.size};
  made.tiles = HugeArray<QuantisedTile>(grid.count());
  for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    QuantisedTile& tile = made.tiles[i];
    TileDraft draft;
    tile.clear();
    for_each_place({x0, y0, x1, y1},
                   [&](int x, int y, std::size_t lane) { tile.put(lane, made.points.at(x, y), draft); });
    tile.finish(draft, draft.bounds.center());  // exact: no error grows with a distance
    publish_receivers();
  });
  return made;
}

ReceiverFinder::ReceiverFinder(const Tracer& tracer) : tracer_(tracer), leaf_of_(hit_places(tracer)) {}

ReceiverCounts ReceiverFinder::find(const View& view, int first_row, const Image<std::uint32_t>& primitive,
                                    Receivers& receivers) const {
  const TileGrid grid{primitive.size};
  if (!(receivers.points.size == primitive.size)) {
    receivers.points = Image<SurfacePoint>(primitive.size);
    receivers.tiles = HugeArray<QuantisedTile>(grid.count());
  }
  std::vector<std::uint64_t> traced(grid.count());
  for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    traced[i] = find_tile(view, first_row, {x0, y0, x1, y1}, primitive, receivers.points, receivers.tiles[i]);
    publish_receivers();
  });
  return {std::accumulate(traced.begin(), traced.end(), std::uint64_t{0})};
}

// As primary_pass() does where it finds the same primitives.
std::uint64_t ReceiverFinder::find_tile(const View& view, int first_row, const TileRect& rect,
                                        const Image<std::uint32_t>& primitives,
                                        Image<SurfacePoint>& receivers, QuantisedTile& quantised) const {
  LaneMask left = every_lane;
  TileDraft draft;
  quantised.clear();
  const Structures& s = tracer_.structures();
  if (rect.is_whole() && packets_apply(tracer_) && !view.orthographic() && !s.has_masks) {
    TileHits known;
    for_each_place(rect, [&](int x, int y, std::size_t lane) {
      const std::uint32_t id = primitives.at(x, y);
      const bool flat = id != no_id && (tracer_.world().is_triangle(id) || leaf_of_[id] >= first_plane);
      known.leaf[lane] = flat ? leaf_of_[id] : nothing_hit;
    });
    const TileRect shown{rect.x0, rect.y0 + first_row, rect.x1, rect.y1 + first_row};
    left = store_receivers(s, view, shown, known,
                           {.points = &receivers.at(rect.x0, rect.y0),
                            .stride = static_cast<std::size_t>(receivers.size.width),
                            .quantised = &quantised,
                            .draft = &draft});
  }
  std::uint64_t missed = 0;
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    SurfacePoint& out = receivers.at(x, y);
    const std::uint32_t id = primitives.at(x, y);
    out = SurfacePoint{};
    if (id == no_id) return;
    const Ray ray = pixel_ray(view, x + 0.5, y + first_row + 0.5);
    std::optional<Hit> hit = hit_at(s, ray, leaf_of_[id]);
    if (!hit) ++missed, hit = tracer_.closest_seen(ray);
    if (!hit) return;
    out = tracer_.surface_point(ray, *hit);
    quantised.put(lane, out, draft);
  });
  quantised.finish(draft, draft.bounds.center());  // from points in double: no error grows with a distance
  return missed;
}

std::uint64_t trace_shadows(const Tracer& tracer, const Receivers& receivers, const Light& light,
                            Image<PointVisibility>& visibility) {
  if (packets_apply(tracer)) return shadow_pass(stored(tracer, receivers), light, visibility).cast;
  std::vector<std::uint64_t> cast(TileGrid{receivers.points.size}.count());
  for_each_pixel(TileGrid{receivers.points.size}, [&](int x, int y, std::size_t tile) {
    const SurfacePoint& point = receivers.points.at(x, y);
    const bool asked = point.primitive != no_id;
    visibility.at(x, y) = asked ? tracer.centre_visibility(point, light) : PointVisibility::lit;
    cast[tile] += asked && !light_cannot_reach(light, point.position, point.normal) ? 1 : 0;
  });
  return std::accumulate(cast.begin(), cast.end(), std::uint64_t{0});
}

void trace_shadows_of(const Tracer& tracer, const Receivers& receivers, const Light& light,
                      std::span<const LaneMask> asked, Image<PointVisibility>& visibility) {
  if (packets_apply(tracer)) return shadow_pass_of(stored(tracer, receivers), light, asked, visibility);
  for_each_tile(TileGrid{receivers.points.size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    for_each_place({x0, y0, x1, y1}, asked[i], [&](int x, int y, std::size_t) {
      visibility.at(x, y) = tracer.centre_visibility(receivers.points.at(x, y), light);
    });
  });
}

}  // namespace gnomon::raytrace
