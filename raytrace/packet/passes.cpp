#include "raytrace/packet/passes.h"

#include "raytrace/packet/tile.h"

namespace gnomon::raytrace {
namespace {

constexpr double widest = 1.5;  // |u| and |v| of a point's rays: the bounds of raytrace/packet/seen.cpp

/// `offset` from a common origin, as a point of the tile's projective plane; false: out of its range.
bool project(const Vec3& offset, TileRays& rays, std::size_t lane, double least_depth) {
  const int k = rays.axis;
  const double depth = rays.sign * offset[k];
  const double inverse = 1.0 / depth, u = offset[(k + 1) % 3] * inverse, v = offset[(k + 2) % 3] * inverse;
  if (!(depth > least_depth && std::abs(u) < widest && std::abs(v) < widest)) return false;
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
  return !s.bvh.nodes.empty() && size > 1e-9 && far < 1e9;
}

Seen seen_from(const Structures& structures, const Light& light) {
  return light.type == LightType::directional ? seen_along(structures, -light.direction)
                                              : seen_from(structures, light.position, true);
}

void primary_tile(const Tracer& tracer, const View& view, const Seen& eye, const TileRect& rect,
                  Image<SurfacePoint>& receivers) {
  const Structures& s = tracer.structures();
  TileRays rays;
  clear(rays);
  choose_axis(pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction, rays);
  std::array<std::uint16_t, tile_packets> wide{};
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    const bool fits = project(pixel_ray(view, x + 0.5, y + 0.5).direction, rays, lane, 0.0);
    (fits ? rays.alive : wide)[lane / packet_rays] |= bit_of(lane);
  });
  TileHits hits;
  closest_in_tile(s.bvh, eye, rays, hits);
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    SurfacePoint& out = receivers.at(x, y);
    const bool fits = (rays.alive[lane / packet_rays] & bit_of(lane)) != 0;
    const std::uint32_t leaf = fits ? hits.leaf[lane] : unsure_hit;
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

std::uint64_t shadow_tile(const Tracer& tracer, const Light& light, const Seen& seen, const TileRect& rect,
                          const Image<SurfacePoint>& receivers, Image<Verdict>& verdicts) {
  TileRays rays;
  clear(rays);
  bool chosen = false;
  std::uint64_t count = 0;
  std::array<std::uint16_t, tile_packets> apart{};
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    const SurfacePoint& point = receivers.at(x, y);
    if (point.primitive == no_id) return;
    if (light_cannot_reach(light, point.position, point.normal)) {
      verdicts.at(x, y) = Verdict::shadowed;
      return;
    }
    ++count;
    if (!chosen) choose_axis(point.position - seen.origin, rays), chosen = true;
    rays.own[lane] = point.primitive;
    (start(seen, point, rays, lane) ? rays.alive : apart)[lane / packet_rays] |= bit_of(lane);
  });
  TileShadows shadows;
  shadows_in_tile(tracer.structures().bvh, seen, rays, shadows);
  for_each_lane(rect, [&](int x, int y, std::size_t lane) {
    const std::size_t packet = lane / packet_rays;
    const std::uint16_t bit = bit_of(lane);
    if ((rays.alive[packet] & bit) == 0 && (apart[packet] & bit) == 0) return;
    if ((apart[packet] & bit) != 0 || (shadows.unsure[packet] & bit) != 0)
      verdicts.at(x, y) = tracer.light_verdict(receivers.at(x, y), light);
    else
      verdicts.at(x, y) = (shadows.shadowed[packet] & bit) != 0 ? Verdict::shadowed : Verdict::lit;
  });
  return count;
}

}  // namespace gnomon::raytrace
