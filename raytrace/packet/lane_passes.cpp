// Single pixels of a tile: shadow rays of some receivers, receivers of pixels whose primitive is known. See
// raytrace/packet/passes.h.
#include "raytrace/packet/passes.h"
#include "raytrace/packet/places.h"
#include "raytrace/packet/prepare.h"
#include "raytrace/packet/receivers.h"

namespace gnomon::raytrace {
namespace {

/// Below this many rays a tile's packets cost more than they save.
constexpr int few_rays = 6;

int longest_axis(const Vec3& v) {
  const Vec3 size = glm::abs(v);
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

/// Where the ray meets the one primitive at this leaf position, if its mask is not a hole there.
std::optional<Hit> known_hit(const Structures& s, const Ray& ray, std::uint32_t leaf) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame || leaf == nothing_hit) return std::nullopt;
  Hit hit;
  const bool met = leaf >= first_plane ? intersect_plane(s, *frame, s.planes[leaf - first_plane], hit)
                                       : intersect_leaf(s, *frame, leaf, hit);
  if (!met || (s.has_masks && !solid(s, *frame, hit))) return std::nullopt;
  hit.t /= frame->kernel_t_from_t;
  return hit;
}

}  // namespace

void shadow_lanes(const Tracer& tracer, const Light& light, const Seen& seen, const TileRect& rect,
                  const LaneMask& asked, const Image<SurfacePoint>& receivers, Image<Verdict>& verdicts) {
  const auto trace = [&](int x, int y, std::size_t) {
    verdicts.at(x, y) = tracer.light_verdict(receivers.at(x, y), light);
  };
  int count = 0;
  for (const std::uint16_t bits : asked) count += std::popcount(bits);
  if (count <= few_rays || seen.primitives.size() == 0 || !is_whole(rect) || light.type == LightType::spot) {
    for_each_place(rect, asked, trace);
    return;
  }
  TileRays rays;
  ShadowLanes lanes;
  std::size_t first = 0;
  while (asked[first] == 0) ++first;
  const TilePlace place =
      tile_place(first * packet_rays + static_cast<std::size_t>(std::countr_zero(asked[first])));
  const Vec3 offset = receivers.at(rect.x0 + place.x, rect.y0 + place.y).position - seen.origin;
  rays.axis = longest_axis(offset), rays.sign = offset[rays.axis] < 0.0 ? -1.0f : 1.0f;
  prepare_shadows(light, seen, &receivers.at(rect.x0, rect.y0),
                  static_cast<std::size_t>(receivers.size.width), rays, lanes);
  for (std::size_t p = 0; p < tile_packets; ++p) rays.alive[p] &= asked[p];
  TileShadows shadows;
  shadows_in_tile(tracer.structures().bvh, seen, rays, shadows);
  LaneMask open;
  for (std::size_t p = 0; p < tile_packets; ++p)
    open[p] = static_cast<std::uint16_t>(shadows.unsure[p] | (asked[p] & ~rays.alive[p]));
  for_each_place(rect, asked, [&](int x, int y, std::size_t lane) {
    const bool dark = (shadows.shadowed[lane / packet_rays] & bit_of(lane)) != 0;
    verdicts.at(x, y) = dark ? Verdict::shadowed : Verdict::lit;
  });
  for_each_place(rect, open, trace);
}

std::uint64_t known_tile(const Tracer& tracer, const View& view, std::span<const std::uint32_t> leaf_of,
                         const TileRect& rect, const Image<std::uint32_t>& primitives,
                         Image<SurfacePoint>& receivers) {
  LaneMask left;
  left.fill(0xffff);
  const Structures& s = tracer.structures();
  if (is_whole(rect) && packets_apply(s) && !s.has_masks) {
    TileHits known;
    for_each_place(rect, [&](int x, int y, std::size_t lane) {
      const std::uint32_t id = primitives.at(x, y);
      known.leaf[lane] = id == no_id || !tracer.world().is_triangle(id) ? nothing_hit : leaf_of[id];
    });
    const Vec3 middle = pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction;
    left = store_receivers(s.bvh, view, rect.x0, rect.y0, longest_axis(middle), known,
                           {.points = &receivers.at(rect.x0, rect.y0),
                            .stride = static_cast<std::size_t>(receivers.size.width)});
  }
  std::uint64_t missed = 0;
  for_each_place(rect, left, [&](int x, int y, std::size_t) {
    SurfacePoint& out = receivers.at(x, y);
    const std::uint32_t id = primitives.at(x, y);
    out = SurfacePoint{};
    if (id == no_id) return;
    const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
    std::optional<Hit> hit = known_hit(s, ray, leaf_of[id]);
    if (!hit) ++missed, hit = tracer.closest_hit(ray);
    if (hit) out = tracer.surface_point(ray, *hit);
  });
  return missed;
}

}  // namespace gnomon::raytrace
