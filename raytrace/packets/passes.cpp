#include "raytrace/packets/passes.h"

#include "raytrace/packets/known_hit.h"
#include "raytrace/packets/places.h"
#include "raytrace/packets/plane_receivers.h"
#include "raytrace/packets/receivers.h"
#include "raytrace/packets/view_block.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

/// Leaves among which a pixel's nearest hit is; `known`: else it may be any.
struct Candidates {
  std::span<const std::uint32_t> leaves;
  bool known = false;
};

/// Where in the tree the triangle lies; ambiguous_hit where that is not known.
std::uint32_t leaf_of(const Tracer& tracer, const Candidates& candidates, std::uint32_t triangle) {
  if (triangle == no_id || !tracer.world().is_triangle(triangle)) return ambiguous_hit;
  for (const std::uint32_t leaf : candidates.leaves)
    if (tracer.structures().bvh.id_at(leaf) == triangle) return leaf;
  return ambiguous_hit;
}

/// The receiver of a pixel whose ray intersects this leaf.
SurfacePoint receiver_of(const Tracer& tracer, const View& view, int x, int y, std::uint32_t leaf,
                         const Candidates& candidates = {}) {
  if (leaf == nothing_hit) return {};
  const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
  // A masked or curved primitive is never a sure hit, so what is found are triangles and planes.
  std::optional<Hit> hit = leaf == ambiguous_hit ? std::nullopt : hit_at(tracer.structures(), ray, leaf);
  if (!hit)
    hit = candidates.known ? tracer.closest_seen_among(ray, candidates.leaves) : tracer.closest_seen(ray);
  return hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
}

/// The same pixels by their rows in the picture.
TileRect in_picture(TileRect rect, int first_row) {
  return {rect.x0, rect.y0 + first_row, rect.x1, rect.y1 + first_row};
}

std::size_t place_in_tile(const TileRect& rect, int x, int y) {
  return static_cast<std::size_t>(tile_pixels * (y - rect.y0) + x - rect.x0);
}

TileHits those_of(const TileHits& hits, const LaneMask& bits) {
  TileHits some;
  for (std::size_t lane = 0; lane < tile_rays; ++lane)
    some.leaf[lane] = (bits[lane / packet_rays] & bit_of(lane)) != 0 ? hits.leaf[lane] : nothing_hit;
  return some;
}

/// Those receivers that are found many at a time; returns the bits of the others.
LaneMask vector_receivers(const Tracer& tracer, const View& view, const TileRect& rect, int first_row,
                          const TileHits& hits, Image<SurfacePoint>* receivers, QuantisedTile* quantised,
                          TileDraft& draft) {
  const Bvh& bvh = tracer.structures().bvh;
  const int axis = axis_of(view, in_picture(rect, first_row)), y0 = rect.y0 + first_row;
  if (receivers != nullptr || quantised == nullptr)
    return store_receivers(bvh, view, rect.x0, y0, axis, hits,
                           {.points = receivers == nullptr ? nullptr : &receivers->at(rect.x0, rect.y0),
                            .stride = static_cast<std::size_t>(view.size.width),
                            .quantised = quantised,
                            .draft = &draft});
  const DraftLeft left = draft_receivers(bvh, view, rect.x0, y0, hits, *quantised, draft);
  if (left.ill == LaneMask{}) return left.others;
  const TileHits ill = those_of(hits, left.ill);
  LaneMask still = store_receivers(bvh, view, rect.x0, y0, axis, ill,
                                   {.points = nullptr, .stride = 0, .quantised = quantised, .draft = &draft});
  for (std::size_t p = 0; p < tile_packets; ++p)
    still[p] = static_cast<std::uint16_t>((still[p] & left.ill[p]) | left.others[p]);
  return still;
}

/// The tile's receivers from its hits in the block.
void store_tile(const Tracer& tracer, const View& view, BlockHits& block, std::size_t index,
                const TileRect& rect, const PrimarySinks& sinks, QuantisedTile* quantised) {
  Image<SurfacePoint>* receivers = sinks.receivers;
  TileHits& hits = block.tiles[index];
  TileDraft draft;
  if (quantised != nullptr) quantised->clear();
  const LaneMask left =
      vector_receivers(tracer, view, rect, sinks.first_row, hits, receivers, quantised, draft);
  const bool any_planes = !tracer.structures().planes.empty();
  HugeArray<SurfacePoint> on_planes(any_planes ? tile_rays : 0);
  LaneMask found{};
  if (any_planes)
    found = find_plane_receivers(tracer.structures(), view, in_picture(rect, sinks.first_row), hits, left,
                                 on_planes.data());
  const auto store = [&](int x, int y, std::size_t lane, const SurfacePoint& point) {
    if (receivers != nullptr) receivers->at(x, y) = point;
    if (quantised != nullptr) quantised->put(lane, point, draft);
  };
  std::vector<std::uint32_t> leaves;
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    const std::uint32_t leaf = hits.leaf[lane];
    if (leaf == nothing_hit) {
      if (receivers != nullptr) receivers->at(x, y) = SurfacePoint{};
      return;
    }
    if ((found[lane / packet_rays] & bit_of(lane)) != 0)
      return store(x, y, lane, on_planes[static_cast<std::size_t>(place_in_tile(rect, x, y))]);
    Candidates candidates;
    if (leaf == ambiguous_hit) {
      leaves.clear();
      for (const AmbiguousBlockHit& candidate : block.ambiguous_at(index * tile_rays + lane))
        leaves.push_back(candidate.leaf);
      candidates = {leaves, block.all_ambiguous};
    }
    const SurfacePoint point = receiver_of(tracer, view, x, y + sinks.first_row, leaf, candidates);
    if (leaf == ambiguous_hit) hits.leaf[lane] = leaf_of(tracer, candidates, point.primitive);
    store(x, y, lane, point);
  });
  if (quantised != nullptr) quantised->finish(draft, view.eye);
}

}  // namespace

void primary_pass(const Tracer& tracer, const View& view, const EdgeSetup& eye, const PrimarySinks& sinks,
                  const std::stop_token& stop) {
  const bool hits_alone = sinks.receivers == nullptr && sinks.quantised.empty();
  for_each_block(sinks.size, stop, [&](const BlockRect& rect) {
    BlockHits block;
    closest_in_block(tracer.structures(), eye, view,
                     {rect.x0, rect.y0 + sinks.first_row, rect.x1, rect.y1 + sinks.first_row}, block);
    for_each_tile_of(rect, [&](std::size_t i, const TileRect& tile) {
      const std::size_t at = tile_at(sinks.size, tile);
      if (!hits_alone)
        store_tile(tracer, view, block, i, tile, sinks,
                   sinks.quantised.empty() ? nullptr : &sinks.quantised[at]);
      if (!sinks.hits.empty()) sinks.hits[at] = block.tiles[i];
    });
  });
}

SurfacePoint ReceiverSource::at(const TileRect& rect, std::size_t lane) const {
  const TilePixel place = tile_pixel(lane);
  const int x = rect.x0 + place.x, y = rect.y0 + place.y;
  return stored != nullptr ? stored->at(x, y)
                           : receiver_of(*tracer, *view, x, y + first_row, hits->leaf[lane]);
}

void ReceiverSource::fill(const TileRect& rect, const LaneMask& asked, SurfacePoint* points) const {
  LaneMask left = asked;
  if (stored == nullptr) {
    const Bvh& bvh = tracer->structures().bvh;
    const TileRect shown = in_picture(rect, first_row);
    for_each_place(rect, asked, [&](int, int, std::size_t lane) {
      if (hits->leaf[lane] < bvh.leaf_count()) bvh.prefetch(hits->leaf[lane]);
    });
    const LaneMask others =
        store_receivers(bvh, *view, shown.x0, shown.y0, axis_of(*view, shown), those_of(*hits, asked),
                        {.points = points, .stride = tile_pixels});
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] &= others[p];
    const LaneMask found = find_plane_receivers(tracer->structures(), *view, shown, *hits, left, points);
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] &= static_cast<std::uint16_t>(~found[p]);
  }
  for_each_place(rect, left,
                 [&](int x, int y, std::size_t lane) { points[place_in_tile(rect, x, y)] = at(rect, lane); });
}

}  // namespace gnomon::raytrace
