#include "raytrace/packet/passes.h"

#include <bit>
#include <cstring>

#include "raytrace/packet/prepare.h"
#include "raytrace/packet/receivers.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {
namespace {

/// `offset` from a common origin, as a point of the tile's projective plane; false: out of its range.
bool project(const Vec3& offset, TileRays& rays, std::size_t lane, double least_depth) {
  const int k = rays.axis;
  const double depth = rays.sign * offset[k];
  const double inverse = 1.0 / depth, u = offset[(k + 1) % 3] * inverse, v = offset[(k + 2) % 3] * inverse;
  if (!(depth > least_depth && std::abs(u) < widest_slope && std::abs(v) < widest_slope)) return false;
  rays.u[lane] = static_cast<float>(u), rays.v[lane] = static_cast<float>(v);
  rays.far[lane] = static_cast<float>(inverse);
  return true;
}

void choose_axis(const Vec3& offset, TileRays& rays) {
  const Vec3 size = glm::abs(offset);
  rays.axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  rays.sign = offset[rays.axis] < 0.0 ? -1.0f : 1.0f;
}

bool start(const Seen& seen, const SurfacePoint& point, TileRays& rays, std::size_t lane) {
  if (!(max_component(glm::abs(point.position)) < seen.reach)) return false;
  const Vec3 offset = point.position - seen.origin;
  if (!seen.directional) return project(offset, rays, lane, 0x1p-30 * seen.reach);
  const double u = glm::dot(offset, seen.axes[0]), v = glm::dot(offset, seen.axes[1]);
  const double height = glm::dot(offset, seen.axes[2]);
  if (!(std::abs(u) < seen.lateral && std::abs(v) < seen.lateral && std::abs(height) < 8.0 * seen.lateral))
    return false;
  rays.u[lane] = static_cast<float>(u), rays.v[lane] = static_cast<float>(v);
  rays.far[lane] = static_cast<float>(height);
  return true;
}

template <class Pixel>
void for_each_lane(const TileRect& rect, const Pixel& pixel) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) pixel(x, y, tile_lane(x - rect.x0, y - rect.y0));
}

bool is_whole(const TileRect& rect) {
  return rect.x1 - rect.x0 == tile_pixels && rect.y1 - rect.y0 == tile_pixels;
}

std::uint16_t bit_of(std::size_t lane) {
  return static_cast<std::uint16_t>(1u << (lane % packet_rays));
}

void clear(TileRays& rays) {
  rays.alive.fill(0);
  for (std::size_t i = 0; i < tile_rays; ++i) rays.u[i] = rays.v[i] = rays.far[i] = 0.0f, rays.own[i] = no_id;
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

}  // namespace

bool packets_apply(const Structures& s) {
  const double size = s.world->finite_bounds.diagonal();
  const double far = max_component(glm::abs(s.bvh.center)) + size;
  return s.precision != Precision::fast && !s.bvh.nodes.empty() && size > 1e-9 && far < 1e9;
}

Seen seen_from(const Structures& structures, const Light& light) {
  return light.type == LightType::directional ? seen_along(structures, -light.direction)
                                              : seen_from(structures, light.position, true);
}

void find_hits(const Tracer& tracer, const View& view, const Seen& eye, const TileRect& rect, TileRays& rays,
               TileHits& hits) {
  choose_axis(pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction, rays);
  if (is_whole(rect)) {
    prepare_primary(view, rect.x0, rect.y0, rays);
  } else {
    clear(rays);
    for_each_lane(rect, [&](int x, int y, std::size_t lane) {
      if (project(pixel_ray(view, x + 0.5, y + 0.5).direction, rays, lane, 0.0))
        rays.alive[lane / packet_rays] |= bit_of(lane);
    });
  }
  closest_in_tile(tracer.structures().bvh, eye, rays, hits);
  for (std::size_t lane = 0; lane < tile_rays; ++lane)
    if ((rays.alive[lane / packet_rays] & bit_of(lane)) == 0) hits.leaf[lane] = unsure_hit;
}

void primary_tile(const Tracer& tracer, const View& view, const Seen& eye, const TileRect& rect,
                  Image<SurfacePoint>& receivers) {
  const Structures& s = tracer.structures();
  TileRays rays;
  TileHits found;
  find_hits(tracer, view, eye, rect, rays, found);
  std::array<std::uint16_t, tile_packets> left;
  left.fill(0xffff);
  // A masked or curved primitive is never a sure hit, so what is found are triangles and planes.
  if (is_whole(rect))
    left = store_receivers(s.bvh, view, rect.x0, rect.y0, rays, found, &receivers.at(rect.x0, rect.y0),
                           static_cast<std::size_t>(receivers.size.width));
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    if ((left[lane / packet_rays] & bit_of(lane)) == 0) return;
    const std::uint32_t leaf = found.leaf[lane];
    SurfacePoint& out = receivers.at(x, y);
    if (leaf == nothing_hit) {
      out = SurfacePoint{};
      return;
    }
    const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
    std::optional<Hit> hit = leaf == unsure_hit ? std::nullopt : hit_at(s, ray, leaf);
    if (!hit) hit = tracer.closest_hit(ray);
    out = hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
  });
}

namespace {

void prepare_partial(const Light& light, const Seen& seen, const TileRect& rect,
                     const Image<SurfacePoint>& receivers, TileRays& rays, ShadowLanes& lanes) {
  clear(rays);
  lanes.apart.fill(0), lanes.unreached.fill(0);
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    const SurfacePoint& point = receivers.at(x, y);
    if (point.primitive == no_id) return;
    rays.own[lane] = point.primitive;
    const bool reached = !light_cannot_reach(light, point.position, point.normal);
    auto& bits = !reached ? lanes.unreached : start(seen, point, rays, lane) ? rays.alive : lanes.apart;
    bits[lane / packet_rays] |= bit_of(lane);
  });
}

/// The axis of depth is chosen for the tile's middle receiver, or the first one where there is none.
void choose_axis(const Seen& seen, const TileRect& rect, const Image<SurfacePoint>& receivers,
                 TileRays& rays) {
  const SurfacePoint* chosen = &receivers.at((rect.x0 + rect.x1) / 2, (rect.y0 + rect.y1) / 2);
  for (int y = rect.y0; y < rect.y1 && chosen->primitive == no_id; ++y)
    for (int x = rect.x0; x < rect.x1 && chosen->primitive == no_id; ++x) chosen = &receivers.at(x, y);
  choose_axis(chosen->position - seen.origin, rays);
}

/// The next tile's receivers come from memory while this one is traced.
void prefetch_right_of(const TileRect& rect, const Image<SurfacePoint>& receivers) {
  if (rect.x1 + tile_pixels > receivers.size.width) return;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const char* row = reinterpret_cast<const char*>(&receivers.at(rect.x1, y));
    for (std::size_t byte = 0; byte < tile_pixels * sizeof(SurfacePoint); byte += 64)
      __builtin_prefetch(row + byte);
  }
}

/// Four pixels' verdicts from four bits: a byte of 1, lit, for every bit.
void store_lit(unsigned lit, Verdict* out) {
  static_assert(static_cast<int>(Verdict::shadowed) == 0 && static_cast<int>(Verdict::lit) == 1);
  const std::uint32_t bytes = (lit * 0x204081u) & 0x01010101u;
  std::memcpy(out, &bytes, sizeof bytes);
}

void store_verdicts(const TileRect& rect, const std::array<unsigned, tile_packets>& dark,
                    Image<Verdict>& verdicts) {
  if (is_whole(rect)) {
    for (int y = 0; y < tile_pixels; ++y)
      for (int x = 0; x < tile_pixels; x += 4) {
        const std::size_t lane = tile_lane(x, y);
        const unsigned lit = ~(dark[lane / packet_rays] >> (lane % packet_rays)) & 0xfu;
        store_lit(lit, &verdicts.at(rect.x0 + x, rect.y0 + y));
      }
    return;
  }
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    verdicts.at(x, y) = (dark[lane / packet_rays] & bit_of(lane)) != 0 ? Verdict::shadowed : Verdict::lit;
  });
}

}  // namespace

namespace {

/// Whether a shape can be in the way of rays that leave it at this point: a sphere seen from within, a solid
/// that is not convex.
bool may_shadow_itself(const ShapeGeometry& geometry, const SurfacePoint& point) {
  if (std::holds_alternative<Plane>(geometry)) return false;
  if (const auto* sphere = std::get_if<Sphere>(&geometry))
    return glm::dot(point.normal, point.position - sphere->center) < 0.0;
  return !is_convex(geometry) || glm::dot(point.normal, solid_normal(geometry, point.position)) < 0.0;
}

/// A ray's own primitive is passed over, which is right of what is flat or convex and seen from outside.
void keep_bent_owners(const World& world, const TileRect& rect, const Image<SurfacePoint>& receivers,
                      TileRays& rays) {
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    const SurfacePoint& point = receivers.at(x, y);
    if (point.primitive == no_id || world.is_triangle(point.primitive)) return;
    if (may_shadow_itself(world.shape(point.primitive).geometry, point)) rays.own[lane] = no_id;
  });
}

}  // namespace

std::uint64_t shadow_tile(const Tracer& tracer, const Light& light, const Seen& seen, const TileRect& rect,
                          const Image<SurfacePoint>& receivers, Image<Verdict>& verdicts) {
  TileRays rays;
  ShadowLanes lanes;
  choose_axis(seen, rect, receivers, rays);
  if (is_whole(rect) && light.type != LightType::spot)
    prepare_shadows(light, seen, &receivers.at(rect.x0, rect.y0),
                    static_cast<std::size_t>(receivers.size.width), rays, lanes);
  else
    prepare_partial(light, seen, rect, receivers, rays, lanes);
  if (tracer.structures().has_shapes) keep_bent_owners(tracer.world(), rect, receivers, rays);
  prefetch_right_of(rect, receivers);
  TileShadows shadows;
  shadows_in_tile(tracer.structures().bvh, seen, rays, shadows);
  std::array<unsigned, tile_packets> dark;
  std::uint64_t count = 0;
  for (std::size_t p = 0; p < tile_packets; ++p) {
    dark[p] = static_cast<unsigned>(shadows.shadowed[p] | lanes.unreached[p]);
    count += static_cast<std::uint64_t>(std::popcount(static_cast<unsigned>(rays.alive[p] | lanes.apart[p])));
  }
  store_verdicts(rect, dark, verdicts);
  for (std::size_t p = 0; p < tile_packets; ++p)
    for (unsigned open = shadows.unsure[p] | lanes.apart[p]; open != 0; open &= open - 1) {
      const auto [x, y] = tile_place(p * packet_rays + static_cast<std::size_t>(std::countr_zero(open)));
      verdicts.at(rect.x0 + x, rect.y0 + y) =
          tracer.light_verdict(receivers.at(rect.x0 + x, rect.y0 + y), light);
    }
  return count;
}

namespace {

/// Below this many rays a tile's packets cost more than they save.
constexpr int few_rays = 6;

template <class Lane>
void for_each_set(const LaneMask& mask, const Lane& lane) {
  for (std::size_t p = 0; p < tile_packets; ++p)
    for (unsigned open = mask[p]; open != 0; open &= open - 1)
      lane(p * packet_rays + static_cast<std::size_t>(std::countr_zero(open)));
}

void prepare_lanes(const Light& light, const Seen& seen, const TileRect& rect,
                   const Image<SurfacePoint>& receivers, TileRays& rays, ShadowLanes& lanes) {
  choose_axis(seen, rect, receivers, rays);
  if (is_whole(rect) && light.type != LightType::spot)
    prepare_shadows(light, seen, &receivers.at(rect.x0, rect.y0),
                    static_cast<std::size_t>(receivers.size.width), rays, lanes);
  else
    prepare_partial(light, seen, rect, receivers, rays, lanes);
}

}  // namespace

void shadow_lanes(const Tracer& tracer, const Light& light, const Seen& seen, const TileRect& rect,
                  const LaneMask& asked, const Image<SurfacePoint>& receivers, Image<Verdict>& verdicts) {
  const auto trace = [&](std::size_t lane) {
    const auto [dx, dy] = tile_place(lane);
    const SurfacePoint& point = receivers.at(rect.x0 + dx, rect.y0 + dy);
    verdicts.at(rect.x0 + dx, rect.y0 + dy) = tracer.light_verdict(point, light);
  };
  int count = 0;
  for (const std::uint16_t bits : asked) count += std::popcount(bits);
  if (count <= few_rays || seen.primitives == nullptr) {
    for_each_set(asked, trace);
    return;
  }
  TileRays rays;
  ShadowLanes lanes;
  prepare_lanes(light, seen, rect, receivers, rays, lanes);
  if (tracer.structures().has_shapes) keep_bent_owners(tracer.world(), rect, receivers, rays);
  for (std::size_t p = 0; p < tile_packets; ++p) rays.alive[p] &= asked[p];
  TileShadows shadows;
  shadows_in_tile(tracer.structures().bvh, seen, rays, shadows);
  LaneMask open;
  for (std::size_t p = 0; p < tile_packets; ++p)
    open[p] = static_cast<std::uint16_t>(shadows.unsure[p] | (asked[p] & ~rays.alive[p]));
  for_each_set(asked, [&](std::size_t lane) {
    const auto [dx, dy] = tile_place(lane);
    const bool dark = (shadows.shadowed[lane / packet_rays] & bit_of(lane)) != 0;
    verdicts.at(rect.x0 + dx, rect.y0 + dy) = dark ? Verdict::shadowed : Verdict::lit;
  });
  for_each_set(open, trace);
}

namespace {

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

std::uint64_t known_tile(const Tracer& tracer, const View& view, std::span<const std::uint32_t> leaf_of,
                         const TileRect& rect, const Image<std::uint32_t>& primitives,
                         Image<SurfacePoint>& receivers) {
  std::array<std::uint16_t, tile_packets> left;
  left.fill(0xffff);
  const Structures& s = tracer.structures();
  if (is_whole(rect) && packets_apply(s) && !s.has_masks) {
    TileRays rays;
    TileHits known;
    choose_axis(pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction, rays);
    prepare_primary(view, rect.x0, rect.y0, rays);
    for_each_lane(rect, [&](int x, int y, std::size_t lane) {
      const std::uint32_t id = primitives.at(x, y);
      known.leaf[lane] = id == no_id || !tracer.world().is_triangle(id) ? nothing_hit : leaf_of[id];
    });
    left = store_receivers(s.bvh, view, rect.x0, rect.y0, rays, known, &receivers.at(rect.x0, rect.y0),
                           static_cast<std::size_t>(receivers.size.width));
  }
  std::uint64_t missed = 0;
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    if ((left[lane / packet_rays] & bit_of(lane)) == 0) return;
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
