#include "compare/exact_depth.h"

#include "compare/biased_test.h"
#include "compare/columns.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

double forward_depth(const LightView& view, int face, const Vec3& position) {
  return glm::dot(position - view.origin, view.face(face).forward);
}

// Infinite where the ray meets nothing; none where it meets the stored primitive nowhere.
std::optional<double> depth_of_stored(const LadderInput& in, raytrace::TexelKey key, const CentreHit& first) {
  const raster::ShadowMap& map = in.record.map;
  if (raster::traits_of(in.drawn.options.map.technique).contents == raster::MapContents::midpoint_depth)
    return std::nullopt;
  if (in.drawn.options.map.cull == raster::Cull::none) return first.depth;
  const std::uint32_t stored = map.primitive[map.texel_index(key.face(), key.column(), key.row())];
  if (stored == no_id) return std::nullopt;
  const Ray ray = caster_ray(map.view, key.face(), key.column() + 0.5, key.row() + 0.5);
  const auto met = first_on_ray(in.tracer, ray, infinity, [&](const raytrace::Hit& hit) {
    return hit.primitive == stored && is_stored_side(in, ray, hit);
  });
  if (!met) return std::nullopt;
  return forward_depth(map.view, key.face(), ray.at(met->t));
}

std::optional<BiasedLookup> lookup_of(const LadderInput& in, std::size_t pixel) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const Vec3 to_light = light_at(in.light, receiver.position).to_light;
  return biased_lookup(in.record, in.drawn.options.map.bias, to_light, receiver, pixel);
}

// Up to the rounding of doubles the receiver itself counts as level with what it is compared with, as in V3.
double gap_before_exact(const LadderInput& in, const BiasedLookup& lookup,
                        const raytrace::SurfacePoint& receiver, double depth) {
  const raytrace::TexelKey key = lookup.key;
  const Ray ray = caster_ray(in.record.map.view, key.face(), key.column() + 0.5, key.row() + 0.5);
  return gap_before(in.record, in.drawn.options.map.bias, receiver.normal, lookup, depth) -
         plane_rounding(ray, receiver);
}

}  // namespace

bool is_stored_side(const LadderInput& in, const Ray& ray, const raytrace::Hit& hit) {
  const raster::Cull cull = in.drawn.options.map.cull;
  if (cull == raster::Cull::none || in.world.is_triangle(hit.primitive)) return true;
  const Vec3 outwards = geometric_normal(in.world, hit.primitive, ray.at(hit.t));
  return (glm::dot(outwards, ray.direction) > 0.0) == (cull == raster::Cull::front);
}

double gap_with_bias(const LowerClimb& lower, const LadderInput& in, std::size_t group, std::size_t pixel,
                     std::size_t& texel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return -infinity;
  const raster::ShadowMap& map = in.record.map;
  const raytrace::TexelKey key = lookup->key;
  texel = map.texel_index(key.face(), key.column(), key.row());
  const double stored = map.depth[texel];
  if (!holds_caster(map.view, stored)) return -infinity;
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const double depth = depth_from_stored(map.view, key.face(), key.row() + 0.5, stored);
  const double exact = lower.centres[group].depth;
  if (key == lower.groups.keys[group] && is_exact(in, depth, exact))
    return gap_before_exact(in, *lookup, receiver, exact);
  return gap_before(in.record, in.drawn.options.map.bias, receiver.normal, *lookup, depth);
}

std::optional<double> exact_gap(const LowerClimb& lower, const LadderInput& in, std::size_t group,
                                std::size_t pixel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return std::nullopt;
  CentreHit first = lower.centres[group];
  if (lookup->key != lower.groups.keys[group]) {
    const TexelCentre centre = trace_centre(in, lookup->key);
    first = {centre.depth, centre.hit ? centre.hit->primitive : no_id};
  }
  const auto depth = depth_of_stored(in, lookup->key, first);
  if (!depth) return std::nullopt;
  if (std::isinf(*depth)) return -infinity;
  return gap_before_exact(in, *lookup, in.traced.receiver.data[pixel], *depth);
}

}  // namespace gnomon::compare
