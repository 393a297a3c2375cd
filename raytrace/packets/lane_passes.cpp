// Receivers of pixels whose primitive is known: raytrace/packets/passes.h.
#include "raytrace/packets/known_hit.h"
#include "raytrace/packets/passes.h"
#include "raytrace/packets/places.h"
#include "raytrace/packets/receivers.h"

namespace gnomon::raytrace {
std::vector<std::uint32_t> hit_places(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  std::vector<std::uint32_t> places(tracer.world().primitive_count(), nothing_hit);
  for (std::uint32_t i = 0; i < s.bvh.leaf_count(); ++i) places[s.bvh.id_at(i)] = i;
  for (std::uint32_t i = 0; i < s.planes.size(); ++i) places[s.planes[i]] = first_plane + i;
  return places;
}

std::uint64_t known_tile(const Tracer& tracer, const View& view, int first_row,
                         std::span<const std::uint32_t> leaf_of, const TileRect& rect,
                         const Image<std::uint32_t>& primitives, Image<SurfacePoint>& receivers,
                         QuantisedTile& quantised) {
  LaneMask left;
  left.fill(0xffff);
  TileDraft draft;
  quantised.clear();
  const Structures& s = tracer.structures();
  if (is_whole(rect) && packets_apply(tracer) && !s.has_masks) {
    TileHits known;
    for_each_place(rect, [&](int x, int y, std::size_t lane) {
      const std::uint32_t id = primitives.at(x, y);
      const bool flat = id != no_id && (tracer.world().is_triangle(id) || leaf_of[id] >= first_plane);
      known.leaf[lane] = flat ? leaf_of[id] : nothing_hit;
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
    std::optional<Hit> hit = hit_at(s, ray, leaf_of[id]);
    if (!hit) ++missed, hit = tracer.closest_seen(ray);
    if (!hit) return;
    out = tracer.surface_point(ray, *hit);
    quantised.put(lane, out, draft);
  });
  quantised.finish(draft, draft.bounds.center());  // from points in double: no error grows with a distance
  return missed;
}

}  // namespace gnomon::raytrace
