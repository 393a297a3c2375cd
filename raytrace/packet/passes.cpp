#include "raytrace/packet/passes.h"

#include "raytrace/packet/cell_tile.h"
#include "raytrace/packet/places.h"
#include "raytrace/packet/plane_receivers.h"
#include "raytrace/packet/prepare.h"
#include "raytrace/packet/receivers.h"
#include "raytrace/packet/view_block.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

/// The world axis along which a ray is longest.
int longest_axis(const Vec3& v) {
  const Vec3 size = glm::abs(v);
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

Vec3 middle_ray(const View& view, const TileRect& rect) {
  return pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction;
}

/// The hit of a ray that is known to meet the primitive at this leaf position.
std::optional<Hit> hit_at(const Structures& s, const Ray& ray, std::uint32_t leaf) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return std::nullopt;
  Hit hit;
  const bool met = leaf >= first_plane ? intersect_plane(s, *frame, s.planes[leaf - first_plane], hit)
                                       : intersect_leaf(s, *frame, leaf, hit);
  if (!met) return std::nullopt;
  hit.t /= frame->kernel_t_from_t;
  return hit;
}

/// Leaves among which a pixel's nearest hit is; `known`: else it may be any.
struct Candidates {
  std::span<const std::uint32_t> leaves;
  bool known = false;
};

/// Of a pixel's cell all that is in its list.
Candidates candidates_in_cell(const Sight& eye, int x, int y) {
  constexpr std::size_t most = 256;  // in longer lists the hierarchy is quicker
  if (!eye.by_cells) return {};
  const Cells& cells = eye.cells;
  const int at = y / 4 * cells.columns() + x / 4;
  const auto cell = static_cast<std::size_t>(at);
  const std::size_t begin = cells.first[cell], count = cells.first[cell + 1] - begin;
  if (count > most) return {};
  return {{cells.leaf.data() + begin, count}, true};
}

/// Where in the tree the triangle lies; unsure_hit where that is not known.
std::uint32_t leaf_of(const Tracer& tracer, const Candidates& candidates, std::uint32_t triangle) {
  if (triangle == no_id || !tracer.world().is_triangle(triangle)) return unsure_hit;
  for (const std::uint32_t leaf : candidates.leaves)
    if (tracer.structures().bvh.ids[leaf] == triangle) return leaf;
  return unsure_hit;
}

/// The receiver of a pixel for which find_hits() gave this leaf.
SurfacePoint receiver_among(const Tracer& tracer, const View& view, int x, int y, std::uint32_t leaf,
                            const Candidates& candidates) {
  if (leaf == nothing_hit) return {};
  const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
  // A masked or curved primitive is never a sure hit, so what is found are triangles and planes.
  std::optional<Hit> hit = leaf == unsure_hit ? std::nullopt : hit_at(tracer.structures(), ray, leaf);
  if (!hit)
    hit = candidates.known ? tracer.closest_hit_among(ray, candidates.leaves) : tracer.closest_hit(ray);
  return hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
}

void prepare_tile(const View& view, const Sight& eye, const TileRect& rect, TileRays& rays) {
  if (eye.by_cells) {
    prepare_framed(view, rect.x0, rect.y0, rays);
  } else {
    const Vec3 middle = middle_ray(view, rect);
    rays.axis = longest_axis(middle), rays.sign = middle[rays.axis] < 0.0 ? -1.0f : 1.0f;
    prepare_primary(view, rect.x0, rect.y0, rays);
  }
  keep_within(rect, rays.alive);
}

std::size_t place_in_tile(const TileRect& rect, int x, int y) {
  return static_cast<std::size_t>(tile_pixels * (y - rect.y0) + x - rect.x0);
}

TileHits those_of(const TileHits& hits, const PacketBits& bits) {
  TileHits some;
  for (std::size_t lane = 0; lane < tile_rays; ++lane)
    some.leaf[lane] = (bits[lane / packet_rays] & bit_of(lane)) != 0 ? hits.leaf[lane] : nothing_hit;
  return some;
}

/// Those receivers that are found many at a time; returns the bits of the others.
PacketBits vector_receivers(const Tracer& tracer, const View& view, const TileRect& rect,
                            const TileHits& hits, Image<SurfacePoint>* receivers, CompactTile* compact,
                            CompactDraft& draft) {
  const Bvh& bvh = tracer.structures().bvh;
  const int axis = longest_axis(middle_ray(view, rect));
  if (receivers != nullptr || compact == nullptr)
    return store_receivers(bvh, view, rect.x0, rect.y0, axis, hits,
                           {.points = receivers == nullptr ? nullptr : &receivers->at(rect.x0, rect.y0),
                            .stride = static_cast<std::size_t>(view.size.width),
                            .compact = compact,
                            .draft = &draft});
  const DraftLeft left = draft_receivers(bvh, view, rect.x0, rect.y0, hits, *compact, draft);
  if (left.ill == PacketBits{}) return left.others;
  const TileHits ill = those_of(hits, left.ill);
  PacketBits still = store_receivers(bvh, view, rect.x0, rect.y0, axis, ill,
                                     {.points = nullptr, .stride = 0, .compact = compact, .draft = &draft});
  for (std::size_t p = 0; p < tile_packets; ++p)
    still[p] = static_cast<std::uint16_t>((still[p] & left.ill[p]) | left.others[p]);
  return still;
}

}  // namespace

namespace {

/// The tile's receivers from its hits. candidates(x, y, lane): of an unsure pixel.
template <class CandidatesOf>
void store_tile(const Tracer& tracer, const View& view, const TileRect& rect, TileHits& hits,
                Image<SurfacePoint>* receivers, CompactTile* compact, const CandidatesOf& candidates) {
  CompactDraft draft;
  if (compact != nullptr) compact->clear();
  const PacketBits left = vector_receivers(tracer, view, rect, hits, receivers, compact, draft);
  const bool any_planes = !tracer.structures().planes.empty();
  HugeArray<SurfacePoint> on_planes(any_planes ? tile_rays : 0);
  PacketBits found{};
  if (any_planes) found = find_plane_receivers(tracer.structures(), view, rect, hits, left, on_planes.data());
  const auto store = [&](int x, int y, std::size_t lane, const SurfacePoint& point) {
    if (receivers != nullptr) receivers->at(x, y) = point;
    if (compact != nullptr) compact->put(lane, point, draft);
  };
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    const std::uint32_t leaf = hits.leaf[lane];
    if (leaf == nothing_hit && receivers == nullptr) return;
    if ((found[lane / packet_rays] & bit_of(lane)) != 0)
      return store(x, y, lane, on_planes[static_cast<std::size_t>(place_in_tile(rect, x, y))]);
    const Candidates some = leaf == unsure_hit ? candidates(x, y, lane) : Candidates{};
    const SurfacePoint point = receiver_among(tracer, view, x, y, leaf, some);
    if (leaf == unsure_hit) hits.leaf[lane] = leaf_of(tracer, some, point.primitive);
    store(x, y, lane, point);
  });
  if (compact != nullptr) compact->finish(draft, view.eye);
}

/// tile(index in the block, its rectangle) for every tile of a block's rectangle.
template <class Tile>
void for_each_tile_of(const BlockRect& block, const Tile& tile) {
  for (int y = block.y0; y < block.y1; y += tile_pixels)
    for (int x = block.x0; x < block.x1; x += tile_pixels) {
      const int index = (y - block.y0) / tile_pixels * block_tiles + (x - block.x0) / tile_pixels;
      tile(static_cast<std::size_t>(index),
           TileRect{x, y, std::min(x + tile_pixels, block.x1), std::min(y + tile_pixels, block.y1)});
    }
}

/// The tile's receivers from a block's hits; `hits` may be the block's own.
void store_tile_of(const Tracer& tracer, const View& view, const BlockHits& block, std::size_t index,
                   const TileRect& rect, TileHits& hits, Image<SurfacePoint>* receivers,
                   CompactTile* compact) {
  std::vector<std::uint32_t> leaves;
  store_tile(tracer, view, rect, hits, receivers, compact, [&](int, int, std::size_t lane) {
    leaves.clear();
    for (const BlockDoubt& doubt : block.doubts_at(index * tile_rays + lane)) leaves.push_back(doubt.leaf);
    return Candidates{leaves, block.all_doubts};
  });
}

/// block(rectangle) for every block of the picture, over all threads.
template <class Block>
void for_each_block(ImageSize size, const Block& block) {
  const int columns = (size.width + block_pixels - 1) / block_pixels;
  const int rows = (size.height + block_pixels - 1) / block_pixels;
  tbb::parallel_for(tbb::blocked_range<int>(0, columns * rows, 1), [&](const tbb::blocked_range<int>& r) {
    for (int i = r.begin(); i != r.end(); ++i) {
      const int x = i % columns * block_pixels, y = i / columns * block_pixels;
      block(BlockRect{x, y, std::min(x + block_pixels, size.width), std::min(y + block_pixels, size.height)});
    }
  });
}

std::size_t tile_at(ImageSize size, const TileRect& rect) {
  return static_cast<std::size_t>(rect.y0 / tile_pixels) * TileGrid{size}.columns() +
         static_cast<std::size_t>(rect.x0 / tile_pixels);
}

}  // namespace

void find_hits(const Tracer& tracer, const View& view, const Sight& eye, const TileRect& rect,
               TileHits& hits) {
  if (eye.by_blocks) {
    BlockHits block;
    closest_in_block(tracer.structures(), eye.seen, view, {rect.x0, rect.y0, rect.x1, rect.y1}, block);
    hits = block.tiles[0];
    return;
  }
  TileRays rays;
  prepare_tile(view, eye, rect, rays);
  if (eye.by_cells)
    closest_in_cells(eye.cells, eye.seen, rays, rect.x0 / 4, rect.y0 / 4, hits);
  else
    closest_in_tile(tracer.structures().bvh, eye.seen, rays, hits);
  for (std::size_t p = 0; p < tile_packets; ++p)
    for (unsigned dead = ~static_cast<unsigned>(rays.alive[p]) & 0xffff; dead != 0; dead &= dead - 1)
      hits.leaf[p * packet_rays + static_cast<std::size_t>(std::countr_zero(dead))] = unsure_hit;
}

void find_all_hits(const Tracer& tracer, const View& view, const Sight& eye, std::span<TileHits> hits) {
  if (!eye.by_blocks)
    return for_each_tile({view.size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      find_hits(tracer, view, eye, {x0, y0, x1, y1}, hits[i]);
    });
  for_each_block(view.size, [&](const BlockRect& rect) {
    BlockHits block;
    closest_in_block(tracer.structures(), eye.seen, view, rect, block);
    for_each_tile_of(
        rect, [&](std::size_t i, const TileRect& tile) { hits[tile_at(view.size, tile)] = block.tiles[i]; });
  });
}

SurfacePoint receiver_of(const Tracer& tracer, const View& view, const Sight& eye, int x, int y,
                         std::uint32_t leaf) {
  return receiver_among(tracer, view, x, y, leaf, candidates_in_cell(eye, x, y));
}

void primary_tile(const Tracer& tracer, const View& view, const Sight& eye, const TileRect& rect,
                  TileHits& hits, Image<SurfacePoint>* receivers, CompactTile* compact) {
  if (eye.by_blocks) {
    BlockHits block;
    closest_in_block(tracer.structures(), eye.seen, view, {rect.x0, rect.y0, rect.x1, rect.y1}, block);
    hits = block.tiles[0];
    return store_tile_of(tracer, view, block, 0, rect, hits, receivers, compact);
  }
  find_hits(tracer, view, eye, rect, hits);
  store_tile(tracer, view, rect, hits, receivers, compact,
             [&](int x, int y, std::size_t) { return candidates_in_cell(eye, x, y); });
}

void primary_pass(const Tracer& tracer, const View& view, const Sight& eye, const PrimarySinks& sinks) {
  const auto compact_of = [&](std::size_t tile) {
    return sinks.compact.empty() ? nullptr : &sinks.compact[tile];
  };
  if (!eye.by_blocks)
    return for_each_tile({view.size}, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      TileHits own;
      primary_tile(tracer, view, eye, {x0, y0, x1, y1}, sinks.hits.empty() ? own : sinks.hits[i],
                   sinks.receivers, compact_of(i));
    });
  for_each_block(view.size, [&](const BlockRect& rect) {
    BlockHits block;
    closest_in_block(tracer.structures(), eye.seen, view, rect, block);
    for_each_tile_of(rect, [&](std::size_t i, const TileRect& tile) {
      const std::size_t at = tile_at(view.size, tile);
      store_tile_of(tracer, view, block, i, tile, block.tiles[i], sinks.receivers, compact_of(at));
      if (!sinks.hits.empty()) sinks.hits[at] = block.tiles[i];
    });
  });
}

SurfacePoint ReceiverSource::at(const TileRect& rect, std::size_t lane) const {
  const TilePlace place = tile_place(lane);
  const int x = rect.x0 + place.x, y = rect.y0 + place.y;
  return stored != nullptr ? stored->at(x, y) : receiver_of(tracer, *view, *eye, x, y, hits->leaf[lane]);
}

void ReceiverSource::fill(const TileRect& rect, const PacketBits& asked, SurfacePoint* points) const {
  PacketBits left = asked;
  if (stored == nullptr) {
    const Bvh& bvh = tracer.structures().bvh;
    for_each_place(rect, asked, [&](int, int, std::size_t lane) {
      if (hits->leaf[lane] < bvh.primitives.size()) bvh.prefetch(hits->leaf[lane]);
    });
    const PacketBits others =
        store_receivers(bvh, *view, rect.x0, rect.y0, longest_axis(middle_ray(*view, rect)),
                        those_of(*hits, asked), {.points = points, .stride = tile_pixels});
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] &= others[p];
    const PacketBits found = find_plane_receivers(tracer.structures(), *view, rect, *hits, left, points);
    for (std::size_t p = 0; p < tile_packets; ++p) left[p] &= static_cast<std::uint16_t>(~found[p]);
  }
  for_each_place(rect, left,
                 [&](int x, int y, std::size_t lane) { points[place_in_tile(rect, x, y)] = at(rect, lane); });
}

}  // namespace gnomon::raytrace
