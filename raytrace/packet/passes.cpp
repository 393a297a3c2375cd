#include "raytrace/packet/passes.h"

#include "raytrace/packet/cell_tile.h"
#include "raytrace/packet/places.h"
#include "raytrace/packet/prepare.h"
#include "raytrace/packet/receivers.h"
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

/// In double; of a pixel's cell only what is in its list.
std::optional<Hit> closest_of_pixel(const Tracer& tracer, const Sight& eye, int x, int y, const Ray& ray) {
  constexpr std::size_t most = 256;  // in longer lists the hierarchy is quicker
  if (!eye.by_cells) return tracer.closest_hit(ray);
  const Cells& cells = eye.cells;
  const auto cell = static_cast<std::size_t>(y / 4 * cells.columns() + x / 4);
  const std::size_t begin = cells.first[cell], count = cells.first[cell + 1] - begin;
  if (count > most) return tracer.closest_hit(ray);
  return tracer.closest_hit_among(ray, {cells.leaf.data() + begin, count});
}

/// Where in the tree a triangle of the pixel's list lies; unsure_hit where that is not known.
std::uint32_t leaf_in_list(const Tracer& tracer, const Sight& eye, int x, int y, std::uint32_t triangle) {
  if (!eye.by_cells || triangle == no_id || !tracer.world().is_triangle(triangle)) return unsure_hit;
  const Cells& cells = eye.cells;
  const auto cell = static_cast<std::size_t>(y / 4 * cells.columns() + x / 4);
  for (std::size_t i = cells.first[cell]; i < cells.first[cell + 1]; ++i)
    if (tracer.structures().bvh.ids[cells.leaf[i]] == triangle) return cells.leaf[i];
  return unsure_hit;
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

void find_hits(const Tracer& tracer, const View& view, const Sight& eye, const TileRect& rect,
               TileHits& hits) {
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

SurfacePoint receiver_of(const Tracer& tracer, const View& view, const Sight& eye, int x, int y,
                         std::uint32_t leaf) {
  if (leaf == nothing_hit) return {};
  const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
  // A masked or curved primitive is never a sure hit, so what is found are triangles and planes.
  std::optional<Hit> hit = leaf == unsure_hit ? std::nullopt : hit_at(tracer.structures(), ray, leaf);
  if (!hit) hit = closest_of_pixel(tracer, eye, x, y, ray);
  return hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
}

void primary_tile(const Tracer& tracer, const View& view, const Sight& eye, const TileRect& rect,
                  TileHits& hits, Image<SurfacePoint>* receivers, CompactTile* compact) {
  find_hits(tracer, view, eye, rect, hits);
  CompactDraft draft;
  if (compact != nullptr) compact->clear();
  const PacketBits left = vector_receivers(tracer, view, rect, hits, receivers, compact, draft);
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    const std::uint32_t leaf = hits.leaf[lane];
    if (leaf == nothing_hit && receivers == nullptr) return;
    const SurfacePoint point = receiver_of(tracer, view, eye, x, y, leaf);
    if (leaf == unsure_hit) hits.leaf[lane] = leaf_in_list(tracer, eye, x, y, point.primitive);
    if (receivers != nullptr) receivers->at(x, y) = point;
    if (compact != nullptr) compact->put(lane, point, draft);
  });
  if (compact != nullptr) compact->finish(draft, view.eye);
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
  }
  for_each_place(rect, left, [&](int x, int y, std::size_t lane) {
    points[tile_pixels * (y - rect.y0) + x - rect.x0] = at(rect, lane);
  });
}

}  // namespace gnomon::raytrace
