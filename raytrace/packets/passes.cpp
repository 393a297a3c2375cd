#include "raytrace/packets/passes.h"

#include "raytrace/packets/known_hit.h"
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
  // A curved primitive or a masked plane is never a sure hit, so what is found are triangles and planes.
  std::optional<Hit> hit = leaf == ambiguous_hit ? std::nullopt : hit_at(tracer.structures(), ray, leaf);
  if (!hit)
    hit = candidates.known ? tracer.closest_seen_among(ray, candidates.leaves) : tracer.closest_seen(ray);
  return hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
}

/// Names the same pixels by their rows in the picture.
TileRect in_picture(TileRect rect, int first_row) {
  return {rect.x0, rect.y0 + first_row, rect.x1, rect.y1 + first_row};
}

TileHits those_of(const TileHits& hits, const LaneMask& bits) {
  TileHits some;
  for (std::size_t lane = 0; lane < tile_rays; ++lane)
    some.leaf[lane] = has_lane(bits, lane) ? hits.leaf[lane] : nothing_hit;
  return some;
}

/// Makes the receivers that are found many at a time; returns the bits of the others.
LaneMask vector_receivers(const Tracer& tracer, const View& view, const TileRect& rect, int first_row,
                          const TileHits& hits, Image<SurfacePoint>* receivers, QuantisedTile* quantised,
                          TileDraft& draft) {
  const Structures& s = tracer.structures();
  const TileRect shown = in_picture(rect, first_row);
  if (receivers != nullptr || quantised == nullptr)
    return store_receivers(s, view, shown, hits,
                           {.points = receivers == nullptr ? nullptr : &receivers->at(rect.x0, rect.y0),
                            .stride = static_cast<std::size_t>(view.size.width),
                            .non_temporal = receivers != nullptr,
                            .quantised = quantised,
                            .draft = &draft});
  const DraftLeft left = draft_receivers(s.bvh, view, shown.x0, shown.y0, hits, *quantised, draft);
  LaneMask asked = left.others;
  for (std::size_t p = 0; p < tile_packets; ++p) asked[p] |= left.ill[p];
  if (asked == LaneMask{}) return asked;
  LaneMask still =
      store_receivers(s, view, shown, those_of(hits, asked), {.quantised = quantised, .draft = &draft});
  for (std::size_t p = 0; p < tile_packets; ++p) still[p] &= asked[p];
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
  std::vector<std::uint32_t> leaves;
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    const std::uint32_t leaf = hits.leaf[lane];
    if (leaf == nothing_hit) {
      if (receivers != nullptr) receivers->at(x, y) = SurfacePoint{};
      return;
    }
    Candidates candidates;
    if (leaf == ambiguous_hit) {
      leaves.clear();
      for (const AmbiguousBlockHit& candidate : block.ambiguous_at(index * tile_rays + lane))
        leaves.push_back(candidate.leaf);
      candidates = {leaves, block.all_ambiguous};
    }
    const SurfacePoint point = receiver_of(tracer, view, x, y + sinks.first_row, leaf, candidates);
    if (leaf == ambiguous_hit) hits.leaf[lane] = leaf_of(tracer, candidates, point.primitive);
    if (receivers != nullptr) receivers->at(x, y) = point;
    if (quantised != nullptr) quantised->put(lane, point, draft);
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
    if (!hits_alone) publish_receivers();
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
    const Structures& s = tracer->structures();
    for_each_place(rect, asked, [&](int, int, std::size_t lane) {
      if (hits->leaf[lane] < s.bvh.leaf_count()) s.bvh.prefetch(hits->leaf[lane]);
    });
    const LaneMask others = store_receivers(s, *view, in_picture(rect, first_row), those_of(*hits, asked),
                                            {.points = points, .stride = tile_pixels});
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] &= others[p];
  }
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    points[tile_pixels * (y - rect.y0) + x - rect.x0] = at(rect, lane);
  });
}

}  // namespace gnomon::raytrace
